#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "common/base/result.h"

namespace footing::text {

/// The cells of a line of comma-separated values, trimmed. Quotes have no meaning.
std::vector<std::string_view> Cells(std::string_view line);

/// The numbers of a line of comma-separated values: `columns` of them, each within +-1e9, which is
/// beyond any unit here and keeps squares and sums finite. An error says what is wrong, not where.
Result<std::vector<double>> NumberRow(std::string_view line, std::size_t columns);

}  // namespace footing::text
