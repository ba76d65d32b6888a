#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "daemon/offline/analysis/sway.h"
#include "daemon/offline/eval/report.h"

namespace footing::eval {

/// `footing-eval board`: measures of sway from a board's corners, or from a COP.
void AddBoardCommand(CLI::App& app, Shared& shared);

/// How a COP is resampled and filtered; 0: not.
struct CopFilter {
  double rate_hz = 0;
  double cutoff_hz = 0;  ///< Only at an even rate.
  double window_s = 0;   ///< Window of the averages, s; 0: two intervals of the slower rate.
};

/// The options of a command line, as given; empty ones have the defaults.
struct CopFilterOptions {
  std::string rate;    ///< Hz, or "recorded".
  std::string cutoff;  ///< Hz, or "none".
  double window_s = 0;
};

/// Loads of a board (`corners`) are noisy and sampled unevenly, so their COP is filtered as usual
/// in posturography; a file of COPs is taken as its author filtered it. A usage error says what
/// does not fit together.
Result<CopFilter> CopFilterOf(const CopFilterOptions& words, bool corners);

/// Seconds of all stretches together.
double DurationS(const posturography::Stretches& stretches);

/// Resamples and filters every stretch, and adds to the answer what was done.
Result<void> FilterCop(const CopFilter& filter, posturography::Stretches& stretches,
                       nlohmann::ordered_json& answer);

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
