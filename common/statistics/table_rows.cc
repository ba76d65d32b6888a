#include "common/statistics/table_rows.h"

#include <algorithm>
#include <cmath>

#include "common/statistics/rate.h"
#include "common/base/csv.h"
#include "common/base/lines.h"
#include "common/base/number.h"

namespace footing::statistics {
namespace {

constexpr double kGreatestValue = 1e100;   // Squares and their sums stay finite.
constexpr double kGreatestExposure = 1e9;  // In any unit; so is the least, 1e-9.

/// Places of the columns in a row.
struct Columns {
  std::size_t count = 0;
  std::size_t value = 0, group = 0;
  std::optional<std::size_t> group_index, subject, exposure;
};

std::string_view Unquoted(std::string_view cell) {
  const bool quoted = cell.size() >= 2 && cell.front() == '"' && cell.back() == '"';
  return quoted ? text::Trim(cell.substr(1, cell.size() - 2)) : cell;
}

std::vector<std::string_view> PlainCells(std::string_view line) {
  std::vector<std::string_view> cells = text::Cells(line);
  for (std::string_view& cell : cells) cell = Unquoted(cell);
  return cells;
}

std::optional<std::size_t> Find(const std::vector<std::string_view>& names, std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

Result<Columns> ReadColumns(const text::Lines& lines, std::string_view line,
                            const TableRequest& request) {
  const std::vector<std::string_view> names = PlainCells(line);
  const bool paired = request.use == TableUse::kPaired;
  const std::string needed = paired ? "subject,group,value" : "group_index,group,value";
  const auto missing = [&](const std::string& name) {
    return lines.Fault("no column " + name + "; the header needs " + needed);
  };
  Columns columns;
  columns.count = names.size();
  const auto value = Find(names, "value"), group = Find(names, "group");
  if (!value) return missing("value");
  if (!group) return missing("group");
  columns.value = *value;
  columns.group = *group;
  columns.group_index = Find(names, "group_index");
  columns.subject = Find(names, "subject");
  if (request.use == TableUse::kCounts) columns.exposure = Find(names, "exposure");
  for (const std::string_view name : {"value", "group", "group_index", "subject", "exposure"}) {
    if (std::count(names.begin(), names.end(), name) > 1) {
      return lines.Fault("two columns are named " + std::string(name));
    }
  }
  if (paired && !columns.subject) return missing("subject");
  if (!paired && !columns.group_index && request.control.empty()) {
    const Error error = missing("group_index");
    return Error{error.kind, error.message + ", or name the control with --control"};
  }
  return columns;
}

Result<double> ReadValue(std::string_view cell, const TableRequest& request) {
  const auto value = text::ToNumber(cell);
  if (!value || std::abs(*value) > kGreatestValue) {
    return InvalidData("the value " + text::Quoted(cell) + " is not a number within +-1e100");
  }
  const bool count = *value >= 0 && *value <= kMostEvents && *value == std::floor(*value);
  if (request.use == TableUse::kCounts && !count) {
    return InvalidData("the value " + text::Quoted(cell) +
                       " is not a count (a whole number from 0 to 1000000)");
  }
  return *value;
}

Result<TableRow> ReadRow(const std::vector<std::string_view>& cells, const Columns& columns,
                         const TableRequest& request) {
  TableRow row;
  row.group = cells[columns.group];
  if (row.group.empty()) return InvalidData("the cell of column group is empty");
  if (columns.group_index) {
    const std::string_view cell = cells[*columns.group_index];
    row.group_index = text::ToCount(cell);
    if (!row.group_index) {
      return InvalidData("the group_index " + text::Quoted(cell) +
                         " is not a whole number from 0, the control");
    }
  }
  if (columns.subject) {
    row.subject = cells[*columns.subject];
    if (row.subject.empty()) return InvalidData("the cell of column subject is empty");
  }
  if (columns.exposure) {
    const auto exposure = text::ToNumber(cells[*columns.exposure]);
    if (!exposure || *exposure < 1 / kGreatestExposure || *exposure > kGreatestExposure) {
      return InvalidData("the exposure " + text::Quoted(cells[*columns.exposure]) +
                         " is not a number from 1e-9 to 1e9");
    }
    row.exposure = *exposure;
  }
  const auto value = ReadValue(cells[columns.value], request);
  if (!value) return value.error();
  row.value = *value;
  return row;
}

}  // namespace

Error TableFault(const TableRequest& request, std::size_t line, const std::string& message) {
  return InvalidData(request.file + ", line " + std::to_string(line) + ": " + message);
}

Result<TableRows> ReadRows(std::string_view text, const TableRequest& request) {
  text::Lines lines(text, request.file);
  const auto header = lines.NextRow();
  if (!header) {
    return TableFault(request, 1, "the file is empty; its first line names the columns");
  }
  const auto columns = ReadColumns(lines, *header, request);
  if (!columns) return columns.error();
  TableRows table;
  table.has_subject = columns->subject.has_value();
  table.has_group_index = columns->group_index.has_value();
  while (const auto line = lines.NextRow()) {
    const std::vector<std::string_view> cells = PlainCells(*line);
    if (cells.size() != columns->count) {
      return lines.Fault(std::to_string(cells.size()) + " cells where the header has " +
                         std::to_string(columns->count));
    }
    auto row = ReadRow(cells, *columns, request);
    if (!row) return lines.Fault(row.error().message);
    row->line = lines.number();
    table.rows.push_back(std::move(row).value());
  }
  table.lines = lines.number();
  if (table.rows.empty()) return lines.Fault("no row below the header");
  return table;
}

}  // namespace footing::statistics
