#include "clients/stream/table.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace footing::stream_client {
namespace {

std::string_view Trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::optional<double> ParseNumber(std::string_view text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number)) {
    return std::nullopt;
  }
  return number;
}

std::vector<std::string_view> Split(std::string_view line) {
  std::vector<std::string_view> cells;
  for (;;) {
    const auto comma = line.find(',');
    cells.push_back(Trim(line.substr(0, comma)));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace

Result<Table> ParseTable(const std::string& text, std::size_t columns, const std::string& origin) {
  Table table;
  std::string_view rest = text;
  for (std::size_t line_number = 1; !rest.empty(); ++line_number) {
    const auto end = rest.find('\n');
    const std::string_view line = Trim(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (line.empty()) continue;
    const auto cells = Split(line);
    const std::string place = origin + " line " + std::to_string(line_number);
    if (line_number == 1 && !ParseNumber(cells[0])) continue;  // A header.
    if (cells.size() != columns) {
      return InvalidData(place + ": " + std::to_string(cells.size()) + " columns, must be " +
                         std::to_string(columns));
    }
    std::vector<double> row;
    for (const std::string_view cell : cells) {
      const auto number = ParseNumber(cell);
      if (!number)
        return InvalidData(place + ": \"" + std::string(cell) + "\" is not a finite number");
      row.push_back(*number);
    }
    table.rows.push_back(std::move(row));
  }
  if (table.rows.empty()) return InvalidData(origin + " holds no rows");
  return table;
}

}  // namespace footing::stream_client
