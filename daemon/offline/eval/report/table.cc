#include "daemon/offline/eval/report/table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "common/config/data_file.h"

namespace footing::eval {
namespace {

constexpr std::size_t kMostBytes = 256u << 20;
constexpr double kGreatest = 1e9;  // Of any unit here; keeps squares and sums finite.

std::string_view Trim(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> Cells(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t comma = line.find(',');
    cells.push_back(Trim(line.substr(0, comma)));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

/// Nothing and `wrong` says why, or the numbers of the line.
std::vector<double> Numbers(std::string_view line, std::size_t columns, std::string& wrong) {
  const std::vector<std::string_view> cells = Cells(line);
  if (cells.size() != columns) {
    wrong = std::to_string(cells.size()) + " cells where " + std::to_string(columns) + " belong";
    return {};
  }
  std::vector<double> numbers;
  for (const std::string_view cell : cells) {
    double value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc() || end != cell.data() + cell.size() ||
        !(std::abs(value) <= kGreatest)) {
      wrong = "no number within +-1e9: ";
      wrong += cell.substr(0, 40);
      return {};
    }
    numbers.push_back(value);
  }
  return numbers;
}

}  // namespace

Result<std::vector<std::vector<double>>> ReadTimeTable(const std::string& path,
                                                       const std::string& columns) {
  const Result<std::string> text = config::ReadTextFile(path, kMostBytes);
  if (!text) return text.error();
  const std::vector<std::string_view> names = Cells(columns);
  std::vector<std::vector<double>> rows;
  std::string_view rest = *text;
  bool header_seen = false;
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = Trim(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (line.empty() || line.front() == '#') continue;
    const std::string where = path + ", line " + std::to_string(number) + ": ";
    if (!header_seen) {
      if (Cells(line) != names) return InvalidData(where + "the header must be " + columns);
      header_seen = true;
      continue;
    }
    std::string wrong;
    std::vector<double> row = Numbers(line, names.size(), wrong);
    if (!wrong.empty()) return InvalidData(where + wrong);
    if (!rows.empty() && row.front() < rows.back().front()) {
      return InvalidData(where + "time goes back, from " + std::to_string(rows.back().front()) +
                         " s to " + std::to_string(row.front()) + " s");
    }
    rows.push_back(std::move(row));
  }
  if (!header_seen) return InvalidData(path + " is empty; its first line must be " + columns);
  return rows;
}

}  // namespace footing::eval
