#pragma once

#include <string>
#include <vector>

#include "common/result/result.h"

namespace footing::eval {

/// The rows of a CSV file whose header is exactly `columns` (comma between names) and whose cells
/// are numbers within +-1e9. The first column is a time that never decreases. Lines that are empty
/// or begin with # are left out. Every error names file, line and what is wrong.
Result<std::vector<std::vector<double>>> ReadTimeTable(const std::string& path,
                                                       const std::string& columns);

}  // namespace footing::eval
