#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "common/result/result.h"

namespace footing::text {

/// The JSON of a text that a person may have written, with comments; `origin` is its file. Of one
/// that is none the error names line and column.
Result<nlohmann::json> ParseJson(const std::string& text, const std::string& origin);

}  // namespace footing::text
