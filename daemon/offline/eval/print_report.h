#pragma once

#include <nlohmann/json.hpp>

#include "common/base/result.h"

namespace footing::eval {

/// To standard output: one line of JSON, or a line for each field, for people.
void PrintReport(const nlohmann::ordered_json& report, bool json);
/// The same, or the error that there is in its place; returns the exit code.
int PrintResult(const Result<nlohmann::ordered_json>& report, bool json);

}  // namespace footing::eval
