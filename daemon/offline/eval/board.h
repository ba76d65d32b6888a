#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/posturography/standing.h"
#include "daemon/offline/eval/report.h"

namespace footing::eval {

/// `footing-eval board`: measures of sway from a board's corners, or from a COP.
void AddBoardCommand(CLI::App& app, Shared& shared);

/// One board of an export, and what the export says about it; nothing where it does not.
struct BoardExport {
  std::vector<posturography::CornerSample> samples;  ///< In seconds since the first one.
  std::optional<bool> simulated;                     ///< At least one sample is.
  std::optional<bool> tared;                         ///< All samples are.
  std::optional<bool> calibrated;                    ///< All samples are.
  std::optional<std::uint64_t> missing_ticks;        ///< Ticks that the whole recording lacks.
};

/// The file is the boards' CSV of `footing-log export`, by its header.
bool IsBoardExport(const std::string& path);

/// One board out of such a file. `board` is a role (left_board), a device number, or empty when the
/// file holds one board only; a usage error lists the boards when it holds several or not that one.
/// Missing ticks come from the file of gaps beside it; where there is none but the export's file of
/// devices, none are missing.
Result<BoardExport> ReadBoardExport(const std::string& path, const std::string& board);

}  // namespace footing::eval
