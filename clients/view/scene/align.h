#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "clients/view/scene/timeline.h"

namespace footing::timeline {

/// At which instant two trials stand side by side: that instant is 0 of both.
enum class Alignment {
  kStart,   ///< The start line, or the beginning of a trial that never crossed it.
  kFinish,  ///< The end of both trials.
  kWall,    ///< The same time of day; 0 is the beginning of the first one.
};

/// One of two recordings to be compared.
struct Side {
  Timeline timeline;  ///< Of what is played, usually one trial; zero is the recording's own.
  /// UNIX time of the recording's zero; nothing when it does not say.
  std::optional<std::int64_t> wall_of_zero_ns;
};

/// The position, on each side's own timeline, that becomes its 0. UsageError when a side does not
/// have what the alignment needs.
Result<std::array<double, 2>> ZerosOf(const std::array<Side, 2>& sides, Alignment alignment);

/// The 0 of a trial that plays alone: where its clock starts.
double ZeroOf(const Timeline& trial);

/// Where one side stands while both play, at a common position within or beside its own time.
struct SideState {
  double at_s = 0;        ///< Position to show.
  bool before = false;    ///< It has not begun: its first state is shown.
  bool finished = false;  ///< It is over: its last state is shown.
};
SideState SideAt(const Timeline& side, double at_s);

/// Marks of both, over the time in which either plays.
Timeline Joined(const Timeline& first, const Timeline& second);

}  // namespace footing::timeline
