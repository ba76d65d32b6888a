#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/statistics/samples.h"

namespace footing::statistics {

/// Purpose for which a table is read.
enum class TableUse {
  kIndependent,  ///< group_index, group, value.
  kPaired,       ///< subject, group, value; every subject in every group once.
  kCounts,       ///< As kIndependent with whole values; exposure, where there is one.
};

/// File to read, and its use.
struct TableRequest {
  std::string file;     ///< For messages.
  std::string control;  ///< Name of the control; empty: see ParseStudyTable.
  TableUse use = TableUse::kIndependent;
};

/// Values of a study by group, and by subject where they are paired.
struct StudyTable {
  Groups groups;                               ///< The control first.
  std::vector<std::vector<double>> exposures;  ///< As `groups`; 1 without such a column.
  /// Where the table has a column subject and each subject one value in every group; of counts,
  /// those per exposure.
  std::optional<Blocks> blocks;
  /// Where some subject has several values, but there are no blocks: why, naming file and line.
  std::string unpaired = {};
};

/// CSV text with a header; other columns are left alone, quotes around a cell are removed. The
/// control is the group named in the request, otherwise the one with group_index 0. A paired table
/// needs no group_index: its control is the group called "control", otherwise the first one. Every
/// error is InvalidData and names file, line and what is wrong.
Result<StudyTable> ParseStudyTable(std::string_view text, const TableRequest& request);

/// One line of a study table.
struct TableRow {
  std::size_t line = 0;  ///< Line in the file, from 1.
  std::string subject;
  std::string group;
  std::optional<std::size_t> group_index;
  double value = 0;
  double exposure = 1;
};

/// Rows of a table, and which of its columns there are.
struct TableRows {
  std::vector<TableRow> rows;
  bool has_subject = false;
  bool has_group_index = false;
  std::size_t lines = 0;
};

/// Cells are checked one by one, nothing between rows.
Result<TableRows> ReadRows(std::string_view text, const TableRequest& request);

/// "FILE, line N: MESSAGE" as InvalidData.
Error TableFault(const TableRequest& request, std::size_t line, const std::string& message);

}  // namespace footing::statistics
