#pragma once

#include <string>

#include "common/stream/setup.h"

namespace footing::board {

inline constexpr double kBoardLengthM = 0.511;  ///< Outer size, along the plate's x.
inline constexpr double kBoardWidthM = 0.316;   ///< Along its y.

/// What is wrong with a layout and what to do, in one line; empty when it can be: a known preset,
/// finite poses near the origin, the left board left of the right one, no overlap, and between
/// their facing edges the gap that is said. Of "single" only the left pose counts.
///
/// Whether the boards really lie like that, no number can tell: the check of the guided set-up
/// (stand left, stand right, lean forward) does.
std::string Problem(const stream::BoardLayout& layout);

/// Distance between the facing edges of two boards; negative when they overlap. It is the largest
/// distance that a line along one of their edges can be put between, so of corner to corner it is
/// less than the straight way.
double GapM(const stream::BoardPose& left, const stream::BoardPose& right);

}  // namespace footing::board
