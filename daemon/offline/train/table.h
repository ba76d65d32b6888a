#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"

namespace footing::train {

struct Table {
  std::vector<std::string> columns;
  Eigen::MatrixXd values;  ///< A row each.
};

/// A CSV text: a line of column names, then numbers within +-1e9 in every cell. Lines that are
/// empty or begin with # are left out. Every error names `origin`, line and what is wrong.
Result<Table> ParseTable(std::string_view text, const std::string& origin);

}  // namespace footing::train
