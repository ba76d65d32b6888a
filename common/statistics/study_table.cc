#include "common/statistics/study_table.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "common/base/text.h"
#include "common/statistics/rate.h"

namespace footing::statistics {
namespace {

/// A group as the rows have it.
struct NamedGroup {
  std::string name;
  std::optional<std::size_t> index;
  std::size_t first_line = 0;
};

std::size_t PlaceOf(const std::vector<NamedGroup>& groups, const std::string& name) {
  const auto found = std::find_if(groups.begin(), groups.end(),
                                  [&](const NamedGroup& group) { return group.name == name; });
  return static_cast<std::size_t>(found - groups.begin());
}

std::string Names(const std::vector<NamedGroup>& groups) {
  std::vector<std::string_view> names;
  for (const NamedGroup& group : groups) names.push_back(group.name);
  return text::Joined(names);
}

/// In the order of the file. A name belongs to one index, an index to one name.
Result<std::vector<NamedGroup>> FindGroups(const TableRows& table, const TableRequest& request) {
  std::vector<NamedGroup> groups;
  std::map<std::size_t, std::string> names;
  for (const TableRow& row : table.rows) {
    const std::size_t place = PlaceOf(groups, row.group);
    if (place == groups.size()) groups.push_back({row.group, row.group_index, row.line});
    if (!row.group_index) continue;
    const NamedGroup& group = groups[place];
    if (group.index != row.group_index) {
      return TableFault(request, row.line,
                        "group " + text::Quoted(row.group) + " has group_index " +
                            std::to_string(*row.group_index) + " here and " +
                            std::to_string(*group.index) + " in line " +
                            std::to_string(group.first_line));
    }
    const auto [known, first] = names.emplace(*row.group_index, row.group);
    if (!first && known->second != row.group) {
      return TableFault(request, row.line,
                        "group_index " + std::to_string(*row.group_index) + " is of group " +
                            text::Quoted(known->second) + " and of " + text::Quoted(row.group));
    }
  }
  return groups;
}

/// The place of the control in `groups`.
Result<std::size_t> FindControl(const std::vector<NamedGroup>& groups, const TableRows& table,
                                const TableRequest& request) {
  if (!request.control.empty()) {
    const std::size_t place = PlaceOf(groups, request.control);
    if (place < groups.size()) return place;
    return TableFault(request, table.lines,
                      "the file ends and no row is of the control " +
                          text::Quoted(request.control) + "; the groups are " + Names(groups));
  }
  if (!table.has_group_index) {
    const std::size_t place = PlaceOf(groups, "control");
    return place < groups.size() ? place : 0;
  }
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (groups[i].index == 0) return i;
  }
  return TableFault(
      request, table.lines,
      "the file ends and no row has group_index 0, the control; the groups are " + Names(groups));
}

/// The control first, the others by index, or in the order of the file.
Result<std::vector<NamedGroup>> OrderedGroups(const TableRows& table, const TableRequest& request) {
  auto found = FindGroups(table, request);
  if (!found) return found.error();
  const auto control = FindControl(*found, table, request);
  if (!control) return control.error();
  std::vector<NamedGroup> groups = std::move(found).value();
  if (groups.size() < 2) {
    return TableFault(request, table.lines,
                      "the file ends and all rows are of the group " +
                          text::Quoted(groups[0].name) + "; a comparison needs two groups");
  }
  const auto first = groups.begin();
  std::rotate(first, first + static_cast<std::ptrdiff_t>(*control),
              first + static_cast<std::ptrdiff_t>(*control) + 1);
  if (!table.has_group_index) return groups;
  std::sort(groups.begin() + 1, groups.end(),
            [](const NamedGroup& a, const NamedGroup& b) { return *a.index < *b.index; });
  std::vector<bool> used(groups.size(), false);
  for (const NamedGroup& group : groups) {
    if (*group.index < used.size()) used[*group.index] = true;
  }
  const auto gap = std::find(used.begin(), used.end(), false);
  if (gap != used.end()) {
    return TableFault(request, table.lines,
                      "the file ends and group_index " + std::to_string(gap - used.begin()) +
                          " has no row, while greater ones have; every group needs a value");
  }
  return groups;
}

bool SomeSubjectRepeats(const TableRows& table) {
  std::set<std::string_view> subjects;
  for (const TableRow& row : table.rows) subjects.insert(row.subject);
  return subjects.size() < table.rows.size();
}

Result<Blocks> ToBlocks(const std::vector<NamedGroup>& groups, const TableRows& table,
                        const TableRequest& request) {
  Blocks blocks;
  for (const NamedGroup& group : groups) blocks.groups.push_back(group.name);
  std::map<std::string, std::size_t> places;
  std::vector<std::vector<const TableRow*>> cells;
  for (const TableRow& row : table.rows) {
    const auto [place, first] = places.emplace(row.subject, cells.size());
    if (first) {
      cells.emplace_back(groups.size(), nullptr);
      blocks.subjects.push_back(row.subject);
    }
    const TableRow*& cell = cells[place->second][PlaceOf(groups, row.group)];
    if (cell != nullptr) {
      return TableFault(request, row.line,
                        "subject " + text::Quoted(row.subject) + " has a second value for group " +
                            text::Quoted(row.group) + " (the first is in line " +
                            std::to_string(cell->line) + "); use their mean or their sum");
    }
    cell = &row;
  }
  for (std::size_t subject = 0; subject < cells.size(); ++subject) {
    std::vector<double>& values = blocks.values.emplace_back();
    for (std::size_t group = 0; group < groups.size(); ++group) {
      if (cells[subject][group] == nullptr) {
        const auto known = std::find_if(cells[subject].begin(), cells[subject].end(),
                                        [](const TableRow* cell) { return cell != nullptr; });
        return TableFault(request, (*known)->line,
                          "subject " + text::Quoted(blocks.subjects[subject]) +
                              " has no value for group " + text::Quoted(groups[group].name) +
                              "; a paired test needs one for each group");
      }
      values.push_back(cells[subject][group]->value / cells[subject][group]->exposure);
    }
  }
  return blocks;
}

}  // namespace

Result<StudyTable> ParseStudyTable(std::string_view text, const TableRequest& request) {
  const auto table = ReadRows(text, request);
  if (!table) return table.error();
  const auto groups = OrderedGroups(*table, request);
  if (!groups) return groups.error();
  StudyTable study;
  for (const NamedGroup& group : *groups) study.groups.push_back({group.name, {}});
  study.exposures.resize(groups->size());
  for (const TableRow& row : table->rows) {
    const std::size_t place = PlaceOf(*groups, row.group);
    study.groups[place].values.push_back(row.value);
    study.exposures[place].push_back(row.exposure);
  }
  if (!table->has_subject) return study;
  auto blocks = ToBlocks(*groups, *table, request);
  if (blocks) {
    study.blocks = std::move(blocks).value();
  } else if (request.use == TableUse::kPaired) {
    return blocks.error();
  } else if (SomeSubjectRepeats(*table)) {
    study.unpaired = blocks.error().message;
  }
  return study;
}

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
