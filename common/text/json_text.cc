#include "common/text/json_text.h"

#include "common/text/library_text.h"

namespace footing::text {

Result<nlohmann::json> ParseJson(const std::string& text, const std::string& origin) {
  try {
    return nlohmann::json::parse(text, nullptr, true, /*ignore_comments=*/true);
  } catch (const nlohmann::json::parse_error& error) {
    return InvalidData(origin + " is not JSON: " + std::string(WithoutTag(error.what())));
  }
}

}  // namespace footing::text
