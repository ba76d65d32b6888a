#pragma once

#include <cstddef>
#include <vector>

#include "common/board/plate.h"
#include "daemon/offline/analysis/sway.h"

namespace footing::posturography {

struct CornerSample {
  double time_s = 0;
  board::CornerForces forces;
};

struct BoardShape {
  stream::BoardGeometry geometry = board::kBalanceBoard;
  /// Less than this is nobody: the board and a step on or off it.
  double least_body_weight_n = board::kContactOffN;
  /// A COP is undefined below this share of the body weight.
  double least_share_of_weight = 0.1;
};

/// Intervals without samples while somebody stood on the board. They end a stretch.
struct Gaps {
  std::size_t count = 0;
  double longest_s = 0;
  double seconds = 0;  ///< Of all together.
};

/// What stood on the board.
struct Standing {
  double weight_n = 0;      ///< Median of the totals while anybody stood on it; 0: nobody did.
  std::size_t samples = 0;  ///< With a COP.
  Stretches stretches;      ///< Ended by stepping off and by gaps in the recording.
  Gaps gaps;
};

/// Longest interval of samples that is not a gap: 99.9 % of a real Balance Board's are below
/// 0.17 s (18 minutes over Bluetooth).
inline constexpr double kLongestIntervalS = 0.2;

/// Centre of pressure in the plate frame (board::CentreOfPressure). Times must not decrease.
Standing FindStanding(const std::vector<CornerSample>& samples, const BoardShape& shape);

/// Cuts samples into stretches at gaps: intervals above kLongestIntervalS and 5 median ones. The
/// weight is unknown.
Standing SplitAtGaps(const std::vector<CopSample>& samples);

}  // namespace footing::posturography
