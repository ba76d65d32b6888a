#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "common/stream/character.h"

/// Whether a character does what it was commanded: a robust one that never follows is of no use.
namespace footing::tracking {

/// Mean speed along the heading over the last half second, about one step of any gait: within a
/// step the speed rises and falls by nature. One value a millisecond; 0 before the first.
class SpeedOverAStep {
 public:
  void Add(double speed_mps);
  double mean_mps() const;

 private:
  std::array<double, 500> last_mps_{};
  std::size_t next_ = 0;
};

/// A command in force: its start, its speed, and the falls counted before it.
struct GivenCommand {
  double time_s = 0;
  double speed_mps = 0;
  std::uint64_t falls_before = 0;
};

/// Outcome of one command.
enum class Tracking {
  kShort,      ///< Given for less than kLongCommandS: not evaluated.
  kTracked,    ///< Its gait runs, at its speed to kTrackedMps, and nobody fell.
  kOtherGait,  ///< Its gait was not reached.
  kFell,
  kOffSpeed,
};
inline constexpr std::size_t kTrackings = 5;
inline constexpr double kLongCommandS = 3;
inline constexpr double kTrackedMps = 0.25;

/// Evaluates a command at its end, `time_s`, by the state then and the mean speed over a step.
Tracking CheckTracking(const GivenCommand& given, double time_s, const stream::GaitState& state,
                       double mean_mps);

}  // namespace footing::tracking
