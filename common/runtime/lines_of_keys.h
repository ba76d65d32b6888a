#pragma once

#include <map>
#include <string>

namespace footing::config {

/// The line, from 1, on which each key of the outermost object of a JSON text with comments stands
/// (the last one of a key that stands twice). Of a text that is not JSON those before the fault.
std::map<std::string, int> LinesOfKeys(const std::string& text);

}  // namespace footing::config
