#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"

namespace footing::stream_client {

/// A CSV table of numbers with a fixed number of columns; the first line may be a header.
struct Table {
  std::vector<std::vector<double>> rows;
};

/// Parses it. Errors name `origin`, the line and what is wrong with it: a column too few or too
/// many, a text that is not a finite number.
Result<Table> ParseTable(const std::string& text, std::size_t columns, const std::string& origin);

}  // namespace footing::stream_client
