#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "daemon/offline/analysis/gait_style.h"
#include "daemon/simulation/engine/engine.h"
#include "daemon/simulation/engine/state.h"

/// Simulated trials of a gait, over which footing-tune searches for its gains.
namespace footing::tune {

inline constexpr double kTrialS = 5;

/// Gait and speed that a set is tuned for.
struct Task {
  stream::Gait gait = stream::Gait::kWalk;
  double speed_mps = 0;
  bool paper = false;  ///< Under the paper's own laws: other disturbances.
  stream::Gait into = stream::Gait::kUnspecified;  ///< The trial is a change to this gait.
  bool style = false;  ///< With style, which is measured: other disturbances.
};

/// Disturbances of a trial. Everything is drawn, and mixed so that no trial of footing-eval draws
/// the same.
struct Disturbance {
  double kick_s = 0;  ///< From the trial's start.
  double kick_ns = 0;
  double kick_direction_rad = 0;
  double turn_rad = 0;  ///< Turn of each step.
  double height_m = 0.2;
  double pit_m = 0;        ///< Width; 0: no pit.
  double pit_ahead_m = 0;  ///< From the start to the near edge.
  double change_s = 0;     ///< From the start to the command of another gait or speed; 0: none.
  biped::GaitCommand change{};
  double trial_s = kTrialS;
  double style_from_s = INFINITY;  ///< From then on the style is measured.
};

/// Disturbances as in the acceptance tests (tests/scenarios/biped_table.py). Half of the trials are
/// pushes of 0.1 s from any side after 1.5 to 2.2 s, of 26 N s (run) or 16 N s and up to 1.3 times
/// that. The others, with a push of 2 N s, turn by 5 degrees a step, or come to a pit, where a run
/// is to jump. Half of the jumps are as high as they are accepted, the others 0.1 m to that. A
/// quarter of the runs are to walk, in place of some of each; a third of those that are pushed turn
/// as well.
///
/// The paper's laws plan no pit: a push of up to 4 N s, and in half of the trials a change to
/// another gait of Figure 9 with a command as `footing-eval transitions` draws it.
///
/// With style 30 % are pushed so, 10 % come to a pit, 10 % turn by 2 degrees a step, up to which
/// the style is there in full, and 10 % change their speed by up to 0.4 m/s. The others go straight
/// on for 8 s, of which the style of the last 5 s is measured.
Disturbance Draw(const Task& task, std::uint64_t seed);

/// Whether the trial's turn is to be followed by the body: no large push disturbs it.
bool ScoresHeading(const Disturbance& disturbance);

/// Whether the legs are to stay beside each other: a large push makes them cross on purpose.
bool ScoresLegs(const Disturbance& disturbance);

/// A straight track with the disturbance's pit, for a trial from `start`.
std::string PitTrack(const engine::EngineState& start, const Disturbance& disturbance);

/// Measures of one trial. A duration or length that was never seen whole is 0.
struct TrialResult {
  double survived = 1;           ///< Fraction of the trial before a fall.
  double speed_error_mps = 0;    ///< Root mean square, of the speed over the last half second.
  double flight_s = 0;           ///< Mean; running, jumping: no foot down; else one foot's swing.
  double stance_s = 0;           ///< Mean; running, jumping: a foot down; else one foot's.
  double stride_m = 0;           ///< Mean; from a foot's touchdown to its next.
  double height_m = 0.2;         ///< That was commanded, of a jump.
  double heading_error_rad = 0;  ///< Root mean square; 0 where it is not scored.
  double leg_gap_m = INFINITY;   ///< Least, between the legs; infinite where it is not scored.
  double latency_s = 0;         ///< From the command of another gait to it, or to the end; 0: none.
  bool reached = true;          ///< The gait commanded last is there at the end.
  style::GaitStyle style = {};  ///< Without a step where it is not measured.
  bool steady = true;           ///< At one speed all along.
};

/// A usage error that names the limit when a speed is beyond the gait's, to which the engine would
/// reduce it.
Result<void> CheckSpeeds(stream::Gait gait, const std::vector<double>& speeds_mps);

/// Tasks that a set of gains is tried at: its own speed and, as gains stay the same beyond the
/// outermost sets, for these the slowest or the fastest speed of the acceptance tests. `paper`: and
/// a change into it from each gait that Figure 9 has before it.
std::vector<Task> TasksOf(stream::Gait gait, const std::vector<double>& speeds_mps, std::size_t set,
                          bool paper = false);

/// States in which trials begin: the gait settled at its speed under the table's gains, at moments
/// of the cycle that `seed` draws. An error when it falls on the way.
Result<std::vector<engine::EngineState>> SettledStates(engine::GaitEngine& engine, const Task& task,
                                                       int count, std::uint64_t seed);

/// One trial from `start`, under the gains that the engine uses. A pit needs an engine
/// on its track. Of a trial that changes its gait, all but the latency is measured before that
/// command; of one that changes its speed, the speed is measured after it.
TrialResult RunTrial(engine::GaitEngine& engine, const engine::EngineState& start, const Task& task,
                     const Disturbance& disturbance);

/// The same number never comes of two different pairs in practice (splitmix64).
std::uint64_t MixSeeds(std::uint64_t a, std::uint64_t b);

/// Mean of what was added.
struct Mean {
  double sum = 0;
  int count = 0;

  void Add(double value) {
    sum += value;
    ++count;
  }
  double value() const { return count > 0 ? sum / count : 0; }
};

/// Measures speed, contacts and strides of a trial, millisecond by millisecond.
class GaitMeter {
 public:
  explicit GaitMeter(const Task& task) : task_(task) {}

  void Add(const engine::EngineOutput& output, double step_s);
  /// All but how long it was survived.
  void Report(TrialResult& result) const;

 private:
  /// A contact without its chatter: a change counts, from its beginning, once it has lasted.
  struct Contact {
    bool known = false;
    bool down = false;
    double since_s = -1;    ///< Negative: not seen from its beginning.
    double changed_s = -1;  ///< Since when it looks otherwise; negative: it does not.
  };

  void Watch(Contact& contact, bool down, double time_s);
  void AddStride(const engine::EngineOutput& output);

  Task task_;
  double time_s_ = 0;
  double mean_speed_mps_ = 0;
  Mean squared_error_, squared_heading_error_;
  std::array<Contact, 2> contacts_;
  Mean flight_s_, stance_s_, stride_m_;
  std::uint64_t steps_ = 0;
  double step_m_ = -1;  ///< Distance at the last touchdown.
  double leg_gap_m_ = INFINITY;
};

}  // namespace footing::tune
