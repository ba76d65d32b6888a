#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace footing::eval {

/// A report of common/statistics as text for people: a table of its rows, then the note.
std::string StatsText(const nlohmann::ordered_json& report);

}  // namespace footing::eval
