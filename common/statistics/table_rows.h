#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/statistics/study_table.h"

namespace footing::statistics {

/// One line of a study table.
struct TableRow {
  std::size_t line = 0;  ///< Of the file, from 1.
  std::string subject;
  std::string group;
  std::optional<std::size_t> group_index;
  double value = 0;
  double exposure = 1;
};

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
