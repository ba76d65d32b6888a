#pragma once

#include <array>
#include <optional>
#include <string>

#include "common/stream/setup.h"

namespace footing::board {

/// Between the facing edges of two boards where nobody measured it.
inline constexpr double kUsualGapMm = 20;

/// Poses of the left and the right board with one foot on each: long sides fore and aft, power
/// buttons outwards, the origin midway between them.
std::array<stream::BoardPose, 2> OneFootEach(double gap_m);

/// Poses by the name of a preset; the origin is midway between the boards.
///   one_foot_each  see OneFootEach
///   side_by_side   long sides across, power buttons to the rear: yaw 0
///   single         one board, as the left one, in the origin
/// Nothing when there is no preset of that name.
std::optional<stream::BoardLayout> LayoutNamed(const std::string& preset, double gap_mm);

/// Where boards lie that nobody has laid out: one_foot_each with the usual gap.
stream::BoardLayout DefaultLayout();

/// A published layout with what it leaves open filled in: the poses of DefaultLayout() where no
/// preset is set. Its geometry stays.
stream::BoardLayout LayoutOr(const stream::BoardLayout& published);

/// Problem of a layout and its remedy, in one line; empty when it is sound: a known preset,
/// finite poses near the origin, the left board left of the right one, no overlap, and between
/// their facing edges the stated gap. Of "single" only the left pose counts.
///
/// Whether the boards really lie like that, no number can show: the check of the guided set-up
/// (stand left, stand right, lean forward) does.
std::string Problem(const stream::BoardLayout& layout);

/// Problem where `boards` boards of `rig` are attached and its layout is this one, and the
/// remedy: "single" puts both into one place, by which every figure would be wrong. Empty: nothing.
std::string ProblemWith(const stream::BoardLayout& layout, std::size_t boards,
                        const std::string& rig);

/// Distance between the facing edges of two boards; negative when they overlap. It is the largest
/// distance that a line along one of their edges can be put between, so of corner to corner it is
/// less than the straight way.
double GapM(const stream::BoardPose& left, const stream::BoardPose& right);

}  // namespace footing::board
