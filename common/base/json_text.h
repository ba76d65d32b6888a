#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "common/base/result.h"

namespace footing::text {

/// The JSON of a text that a person may have written, with comments; `origin` is its file. Of one
/// that is none the error names line and column. An object with one key twice is refused, since
/// only one of its values could be taken.
Result<nlohmann::json> ParseJson(const std::string& text, const std::string& origin);
/// The same with the keys in the order of the text.
Result<nlohmann::ordered_json> ParseOrderedJson(const std::string& text, const std::string& origin);

/// The text value of a setting, {"settings": {KEY: VALUE}}, in the effective config that a
/// recording carries. Nothing where it has none, or is torn.
std::optional<std::string> SettingIn(const std::string& effective_config, const std::string& key);

/// JSON as text, on one line where `indent` is -1. Bytes that are not UTF-8, as names of files may
/// hold, are replaced.
template <typename Json>
std::string ToText(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace footing::text
