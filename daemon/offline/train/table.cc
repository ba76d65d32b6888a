#include "daemon/offline/train/table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

namespace footing::train {
namespace {

constexpr double kGreatest = 1e9;

std::string_view Trim(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Calls `take` for each cell; false as soon as it says so.
template <typename Take>
bool ForCells(std::string_view line, const Take& take) {
  while (true) {
    const std::size_t comma = line.find(',');
    if (!take(Trim(line.substr(0, comma)))) return false;
    if (comma == std::string_view::npos) return true;
    line.remove_prefix(comma + 1);
  }
}

/// Appends the line's numbers; empty, or what is wrong.
std::string TakeNumbers(std::string_view line, std::size_t columns, std::vector<double>& numbers) {
  const std::size_t before = numbers.size();
  std::string wrong;
  ForCells(line, [&](std::string_view cell) {
    double value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc() || end != cell.data() + cell.size() ||
        !(std::abs(value) <= kGreatest)) {
      wrong = "no number within +-1e9: " + std::string(cell.substr(0, 40));
      return false;
    }
    numbers.push_back(value);
    return true;
  });
  if (wrong.empty() && numbers.size() - before != columns) {
    wrong = std::to_string(numbers.size() - before) + " cells where " + std::to_string(columns) +
            " belong";
  }
  return wrong;
}

}  // namespace

Result<Table> ParseTable(std::string_view text, const std::string& origin) {
  Table table;
  std::vector<double> numbers;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = Trim(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.empty() || line.front() == '#') continue;
    const std::string where = origin + ", line " + std::to_string(number) + ": ";
    if (table.columns.empty()) {
      ForCells(line, [&](std::string_view name) {
        table.columns.emplace_back(name);
        return true;
      });
      const std::set<std::string> names(table.columns.begin(), table.columns.end());
      if (names.count("") != 0 || names.size() != table.columns.size()) {
        return InvalidData(where + "the first line must name every column, each differently");
      }
      continue;
    }
    const std::string wrong = TakeNumbers(line, table.columns.size(), numbers);
    if (!wrong.empty()) return InvalidData(where + wrong);
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
