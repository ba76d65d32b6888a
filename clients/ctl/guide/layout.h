#pragma once

#include <optional>
#include <string>

#include "clients/ctl/guide/recent.h"
#include "common/stream/setup.h"

namespace footing::guide {

inline constexpr double kBoardLongM = 0.511;  ///< Outer size of a Balance Board.
inline constexpr double kBoardShortM = 0.316;
inline constexpr double kUsualGapMm = 20;

/// Poses of the boards; the origin is midway between them.
///   one_foot_each  long axes fore and aft, power buttons outwards: left yaw -90 deg, right +90 deg
///   side_by_side   long axes across, power buttons to the rear: yaw 0
///   single         one board, as the left one, in the origin
/// Nothing when there is no preset of that name.
std::optional<stream::BoardLayout> LayoutNamed(const std::string& preset, double gap_mm);

/// The boards from above, drawn for a terminal; empty when there is no preset of that name.
std::string LayoutPicture(const std::string& preset);

struct WorldPoint {
  double x_m = 0;  ///< Forward.
  double y_m = 0;  ///< Left.
};

/// A point of the plate frame P (x right, y front) in the world frame W. With yaw 0 the plate's
/// front points forward.
WorldPoint InWorld(const stream::BoardPose& pose, double x_P_m, double y_P_m);

/// Centre of pressure of both boards together, by moments about the world's origin.
struct CombinedCop {
  bool valid = false;
  bool degraded = false;  ///< One board alone: weight beside it is not seen.
  double total_n = 0;
  WorldPoint at;
};
CombinedCop Combine(const stream::BoardLayout& layout, const Load* left, const Load* right);

/// Loads while the person did as asked. A board that is not there has no samples.
struct Stance {
  Load left;  ///< Of the board that has the role left_board.
  Load right;
};

struct LayoutObserved {
  std::optional<Stance> left_alone;  ///< Both are needed to find swapped boards.
  std::optional<Stance> right_alone;
  Stance upright;
  Stance forward;
};

enum class LayoutFault { kNone, kNoContact, kSwapped, kLeftTurned, kRightTurned, kBothTurned };

struct LayoutVerdict {
  LayoutFault fault = LayoutFault::kNone;
  bool degraded = false;
  double residual_mm = 0;  ///< Sideways movement of the COP while leaning forward: 0 is ideal.
  double rest_n = 0;       ///< Largest force on a board that should have been free.
  std::string note;        ///< What is wrong and what to do, or the figures.

  bool passed() const { return fault == LayoutFault::kNone; }
};

/// Leaning forward must move each board's COP forward in W; standing left must load the left one.
LayoutVerdict JudgeLayout(const stream::BoardLayout& layout, const LayoutObserved& observed);

inline constexpr double kLeastLeanM = 0.015;  ///< Less movement than this is no lean.

}  // namespace footing::guide
