#pragma once

#include <string_view>

namespace footing::text {

/// What a JSON library reports, for a person: without the tag "[json.exception.NAME.NUMBER] ".
constexpr std::string_view WithoutTag(std::string_view message) {
  const std::size_t end = message.starts_with('[') ? message.find("] ") : std::string_view::npos;
  return end == std::string_view::npos ? message : message.substr(end + 2);
}

}  // namespace footing::text
