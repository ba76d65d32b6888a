#pragma once

#include <string_view>

namespace footing::skeleton {

/// A file of the page, which is part of the program.
struct PageFile {
  std::string_view name;
  std::string_view type;  ///< Of its content, for HTTP.
  std::string_view text;
};

/// "" is index.html; nullptr where there is no such file.
const PageFile* FindPageFile(std::string_view name);

}  // namespace footing::skeleton
