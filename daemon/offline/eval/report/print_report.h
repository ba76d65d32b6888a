#pragma once

#include <nlohmann/json.hpp>

namespace footing::eval {

/// To standard output: one line of JSON, or a line for each field, for people.
void PrintReport(const nlohmann::ordered_json& report, bool json);

}  // namespace footing::eval
