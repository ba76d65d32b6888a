#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/result.h"

namespace footing::render {

/// Pixels, red green blue, top row first.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

/// Writes a PNG; the error names the file.
Result<void> WritePng(const Image& image, const std::string& path);
/// Writes a JPEG where the name ends in .jpg or .jpeg, else a PNG.
Result<void> WritePicture(const Image& image, const std::string& path);

}  // namespace footing::render
