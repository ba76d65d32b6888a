#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/stream/character.h"
#include "daemon/simulation/gait/gain_fields.h"

/// Tables of the gaits: for each gait a few sets of gains, each for a speed, and the states of the
/// controllers with the arrows between them.
namespace footing::gait {

/// The gains of one gait at one speed.
struct GainSet {
  std::string name;      ///< "slow", "fast", ...
  double speed_mps = 0;  ///< v_d at which the set holds as it is.
  Gains gains;
};

/// The sets of each gait, in the order of stream::kGaits.
using GainSets = std::array<std::vector<GainSet>, stream::kGaits.size()>;

/// The gains between `a` (share 0) and `b` (share 1).
Gains Between(const Gains& a, const Gains& b, double share);

/// The sets of every gait. A gait without any has the defaults of gains.h.
class GainTable {
 public:
  /// Reads one file (docs/tuning.md): lines that are empty or begin with # are left out, then
  /// come the columns' names (gait, set, speed_mps, and any of GainFields), a row with their units
  /// (- for text), and one row a set, the speeds of a gait rising. What it has for a gait replaces
  /// what the table had; a gain without a column keeps its default. `origin` names the file in
  /// errors.
  Result<void> Add(std::string_view text, const std::string& origin);

  void Set(stream::Gait gait, std::vector<GainSet> sets);
  const std::vector<GainSet>& SetsOf(stream::Gait gait) const;

  /// The gains of a gait at a desired speed: linear between the two nearest sets, the outermost
  /// set beyond. Walking and stepping take the laws of hopping from running's sets, for the thrust
  /// that leads there; running and jumping take those of walking from walking's.
  Gains At(stream::Gait gait, double desired_speed_mps) const;

 private:
  GainSets sets_;
};

/// A table's text, with `comment` (lines without #) before it and these columns only.
std::string WriteGains(stream::Gait gait, const std::vector<GainSet>& sets,
                       const std::vector<const GainField*>& columns, const std::string& comment);

/// States of the walking and stepping controllers (Figure 5), for each supporting leg.
enum class WalkingPhase { kDoubleSupport, kRise, kFall };

/// States of the running controller (Figure 6); jumping uses one copy of it for both legs.
enum class RunningPhase { kUpwardFlight, kDownwardFlight, kCompression, kExtension };

/// The figures' words: "double support", "rise", ...
const char* Name(WalkingPhase phase);
const char* Name(RunningPhase phase);

/// Cues of the state for the walking machine.
struct WalkingCues {
  /// Its time is over and the front foot touches, or has had 0.1 s more: the rear leg is picked up,
  /// whatever load it still has.
  bool double_support_over = false;
  bool half_swing_over = false;
  bool swing_foot_landed = false;
};

/// Cues of the state for the running machine. In jumping the two legs are one virtual leg.
struct RunningCues {
  bool falling = false;       ///< The COM moves down.
  bool landed_early = false;  ///< A foot touches, long after lift-off, still moving up.
  bool landed = false;
  bool leg_shortest = false;  ///< The stance leg has stopped shortening.
  bool lifted_off = false;    ///< The thrust is over or the feet have left the ground.
};

/// One arrow of a figure: in `from`, when the cue holds, to `to`.
template <typename Phase, typename Cues>
struct Arrow {
  Phase from;
  bool Cues::*cue;
  Phase to;
  const char* when;  ///< The cue in words, for the figure.
};

/// The arrows of Figure 5. Of one phase's arrows the first one whose cue holds is taken.
inline constexpr std::array<Arrow<WalkingPhase, WalkingCues>, 3> kWalkingArrows{{
    {WalkingPhase::kDoubleSupport, &WalkingCues::double_support_over, WalkingPhase::kRise,
     "double support time over, front foot loaded"},
    {WalkingPhase::kRise, &WalkingCues::half_swing_over, WalkingPhase::kFall,
     "half the swing is over"},
    {WalkingPhase::kFall, &WalkingCues::swing_foot_landed, WalkingPhase::kDoubleSupport,
     "swing foot lands"},
}};
/// The arrows of Figure 6, and one for a foot that touches while the COM still rises.
inline constexpr std::array<Arrow<RunningPhase, RunningCues>, 5> kRunningArrows{{
    {RunningPhase::kUpwardFlight, &RunningCues::landed_early, RunningPhase::kCompression,
     "a foot touches early"},
    {RunningPhase::kUpwardFlight, &RunningCues::falling, RunningPhase::kDownwardFlight,
     "COM moves down"},
    {RunningPhase::kDownwardFlight, &RunningCues::landed, RunningPhase::kCompression,
     "foot touches"},
    {RunningPhase::kCompression, &RunningCues::leg_shortest, RunningPhase::kExtension,
     "leg at its shortest"},
    {RunningPhase::kExtension, &RunningCues::lifted_off, RunningPhase::kUpwardFlight,
     "leg at its thrust length, or off the ground"},
}};

/// The phase that follows by the tables above.
WalkingPhase Next(WalkingPhase phase, const WalkingCues& cues);
RunningPhase Next(RunningPhase phase, const RunningCues& cues);

/// The figures as Mermaid state diagrams, drawn from the tables above.
std::string DrawWalkingMachine();
std::string DrawRunningMachine();

constexpr bool IsHopping(stream::Gait gait) {
  return gait == stream::Gait::kRun || gait == stream::Gait::kJump;
}

}  // namespace footing::gait
