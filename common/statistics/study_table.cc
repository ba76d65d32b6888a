#include "common/statistics/study_table.h"

#include <algorithm>
#include <map>
#include <set>

#include "common/statistics/table_rows.h"
#include "common/base/joined.h"
#include "common/base/lines.h"

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

}  // namespace footing::statistics
