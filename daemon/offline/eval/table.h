#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"

namespace footing::eval {

/// The rows of a CSV file whose header is exactly `columns` (comma between names) and whose cells
/// are numbers within +-1e9. The first column is a time that never decreases. Lines that are empty
/// or begin with # are left out. Every error names file, line and what is wrong.
Result<std::vector<std::vector<double>>> ReadTimeTable(const std::string& path,
                                                       const std::string& columns);

/// The cells, as text, of the columns with these names out of a CSV file whose header holds them
/// among others, in any order. Cells in quotes are not understood: such columns stay unread.
/// InvalidData names the column that is missing or the line that is too short.
Result<std::vector<std::vector<std::string>>> ReadNamedColumns(
    const std::string& path, const std::vector<std::string>& names);

/// The names in a CSV file's first line; none when the file cannot be read or is empty.
std::vector<std::string> ReadHeader(const std::string& path);

}  // namespace footing::eval
