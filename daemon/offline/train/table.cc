#include "daemon/offline/train/table.h"

#include <set>

#include "common/base/csv.h"
#include "common/base/lines.h"

namespace footing::train {

Result<Table> ParseTable(std::string_view text, const std::string& origin) {
  Table table;
  std::vector<double> numbers;
  text::Lines lines(text, origin);
  while (const auto line = lines.NextRow()) {
    if (table.columns.empty()) {
      for (const std::string_view name : text::Cells(*line)) table.columns.emplace_back(name);
      const std::set<std::string> names(table.columns.begin(), table.columns.end());
      if (names.count("") != 0 || names.size() != table.columns.size()) {
        return lines.Fault("the first line must name every column, each differently");
      }
      continue;
    }
    const auto row = text::NumberRow(*line, table.columns.size());
    if (!row) return lines.Fault(row.error().message);
    numbers.insert(numbers.end(), row->begin(), row->end());
  }
  if (numbers.empty()) {
    return InvalidData(origin + ": no rows; a line of column names comes first, then numbers");
  }
  const auto columns = static_cast<Eigen::Index>(table.columns.size());
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  table.values =
      RowMajor::Map(numbers.data(), static_cast<Eigen::Index>(numbers.size()) / columns, columns);
  return table;
}

}  // namespace footing::train
