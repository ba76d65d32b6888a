#include "daemon/offline/tune/trial.h"

#include <algorithm>
#include <cmath>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/virtual/devices/noise.h"
#include "daemon/offline/analysis/leg_gap.h"
#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/biped/track.h"
#include "daemon/simulation/gait/transition.h"

namespace footing::tune {
namespace {

using stream::Gait;

constexpr double kStepS = 0.001;
constexpr std::uint64_t kTuneSalt = 0x666f6f74696e67;  // Keeps tuning off the suite's seeds.
constexpr double kSettleS = 6;
constexpr double kBetweenStatesS = 0.61;

constexpr double kTurnDeg = 5;
constexpr double kSmallKickNs = 2;
constexpr double kLowestM = 0.1;
constexpr double kJumpLeadS = 0.8;

/// Pushes are the acceptance tests' and up to this times as large: at theirs hardly any falls, and
/// a search learns nothing.
constexpr double kBeyondTest = 1.3;

struct Range {
  double min, max;
};

/// When a run is to walk: the range is longer than a cycle (0.9 s), so that each of its moments is
/// drawn, and early enough for the walk to be seen.
constexpr Range kChangesS{0.2, 1.2};
constexpr Range kWalksMps{0.2, 1.4};  // As in `footing-eval transitions`.

/// Shares of the trials, added up: pushed in a turn; pushed; turning; at a pit. The others are to
/// walk; with style see DrawStyled.
struct Shares {
  double pushed_turning, pushed, turning, pits;
};

Shares SharesOf(const Task& task) {
  if (task.style) return {0, 0.3, 0.3, 0.4};
  if (task.gait == Gait::kRun) return {0.15, 0.45, 0.6, 0.75};
  return {0, 0.5, 0.75, 1};
}

/// Trials under the paper's laws.
constexpr double kPaperKickNs = 4;
constexpr double kPaperChangeTrialS = 9;  // Leaving a run takes up to four seconds.
constexpr Range kPaperChangesS{0.2, 1.7};

/// Speeds from the slowest to the fastest that the acceptance tests have; `paper`: that the paper's
/// gaits are tuned for.
Range TestedMps(Gait gait, bool paper) {
  switch (gait) {
    case Gait::kWalk:
      return paper ? Range{0.2, 1.4} : Range{0.25, 1.75};
    case Gait::kRun:
      return paper ? Range{1.5, 4} : Range{2, 6};
    case Gait::kJump:
      return paper ? Range{0, 1} : Range{0, 2};
    case Gait::kStep:
    case Gait::kUnspecified:
      return {0, 0};
  }
  return {0, 0};
}

Disturbance DrawPaper(const Task& task, noise::Random& random) {
  constexpr Range kHeightsM{0.1, 0.35};
  const auto drawn_of = [&random](const Range& range) {
    return random.Uniform(range.min, range.max);
  };
  Disturbance drawn{.kick_s = random.Uniform(0.5, 1.2),
                    .kick_ns = random.Uniform(0, kPaperKickNs),
                    .kick_direction_rad = random.Uniform(-kPi, kPi),
                    .height_m = drawn_of(kHeightsM)};
  std::vector<Gait> gaits{task.into};
  if (task.into == Gait::kUnspecified) {
    if (random.Uniform() < 0.5) return drawn;
    gaits.clear();
    for (const Gait gait : stream::kGaits) {
      if (gait != task.gait && gait::IsDirect(task.gait, gait)) gaits.push_back(gait);
    }
  }
  const auto choice =
      static_cast<std::size_t>(random.Uniform() * static_cast<double>(gaits.size()));
  drawn.change.gait = gaits[std::min(choice, gaits.size() - 1)];
  drawn.change.speed_mps = drawn_of(TestedMps(drawn.change.gait, true));
  drawn.change.height_m = drawn_of(kHeightsM);
  drawn.change_s = drawn_of(kPaperChangesS);
  drawn.trial_s = kPaperChangeTrialS;
  return drawn;
}

/// Trials with style.
constexpr double kStyleSettlesS = 3;
constexpr double kStyledTurnDeg = 2;
constexpr double kSlowestStyledMps = 0.2;
constexpr Range kSpeedChangesMps{0.2, 0.4};

Disturbance DrawStyled(const Task& task, double kind, noise::Random& random, Disturbance drawn) {
  constexpr double kTurning = 0.1, kChanging = 0.2;
  drawn.kick_s = random.Uniform(0, 0.5);
  const double sign = random.Uniform() < 0.5 ? 1 : -1;
  if (kind < kTurning) {
    drawn.turn_rad = sign * DegreesToRadians(kStyledTurnDeg);
  } else if (kind < kChanging) {
    const double by_mps = random.Uniform(kSpeedChangesMps.min, kSpeedChangesMps.max);
    drawn.change_s = drawn.style_from_s = 1 + random.Uniform(0, 1);
    drawn.change = {.gait = task.gait,
                    .speed_mps = std::max(kSlowestStyledMps, task.speed_mps + sign * by_mps)};
    drawn.change = biped::Limited(drawn.change);
  } else {
    drawn.style_from_s = kStyleSettlesS;
    drawn.trial_s = kStyleSettlesS + kTrialS;
  }
  return drawn;
}

double TestedKickNs(Gait gait) { return gait == Gait::kRun ? 26 : 16; }

/// Widths of pits that the gait is to cross, m; none: 0.
Range PitWidths(const Task& task) {
  switch (task.gait) {
    case Gait::kWalk:
      return {0.05, 0.3};
    case Gait::kRun:
      return {0.4, task.speed_mps > 3.6 ? 1.0 : 1.5};
    case Gait::kJump:
      return task.speed_mps < 1 ? Range{0, 0} : Range{0.3, 1.0};
    case Gait::kStep:
    case Gait::kUnspecified:
      return {0, 0};
  }
  return {0, 0};
}

engine::EngineInputs Inputs(const Task& task) {
  engine::EngineInputs inputs;
  inputs.direct = true;
  inputs.direct_command = {.gait = task.gait, .speed_mps = task.speed_mps};
  return inputs;
}

bool Fell(const engine::EngineOutput& output) {
  for (int i = 0; i < output.event_count; ++i) {
    if (output.events[static_cast<std::size_t>(i)].kind == engine::EventKind::kFall) return true;
  }
  return false;
}

int StepsOf(double duration_s) { return static_cast<int>(std::lround(duration_s / kStepS)); }

void Kick(const Disturbance& disturbance, engine::EngineInputs& inputs) {
  ++inputs.push_number;
  inputs.push_impulse_W_ns =
      disturbance.kick_ns * Eigen::Vector2d(std::cos(disturbance.kick_direction_rad),
                                            std::sin(disturbance.kick_direction_rad));
}

}  // namespace

std::uint64_t MixSeeds(std::uint64_t a, std::uint64_t b) {
  std::uint64_t z = a * 0x9e3779b97f4a7c15u + b + kTuneSalt;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

Result<void> CheckSpeeds(Gait gait, const std::vector<double>& speeds_mps) {
  for (const double speed_mps : speeds_mps) {
    const double most_mps = biped::Limited({.gait = gait, .speed_mps = speed_mps}).speed_mps;
    if (speed_mps <= most_mps) continue;
    return UsageError("--speeds: " + text::Shortest(speed_mps) + " m/s is beyond the limit of " +
                      std::string(stream::Name(gait)) + ", " + text::Shortest(most_mps) +
                      " m/s; choose lower speeds");
  }
  return {};
}

std::vector<Task> TasksOf(Gait gait, const std::vector<double>& speeds_mps, std::size_t set,
                          bool paper) {
  const Range tested = TestedMps(gait, paper);
  const double own_mps = speeds_mps[set];
  std::vector<Task> tasks{{gait, own_mps, paper}};
  if (set == 0 && tested.min < own_mps) tasks.push_back({gait, tested.min, paper});
  if (set + 1 == speeds_mps.size() && tested.max > own_mps) {
    tasks.push_back({gait, tested.max, paper});
  }
  for (const Gait from : stream::kGaits) {
    if (!paper || from == gait || !gait::IsDirect(from, gait)) continue;
    const Range range = TestedMps(from, true);
    tasks.push_back({from, (range.min + range.max) / 2, paper, gait});
  }
  return tasks;
}

Result<std::vector<engine::EngineState>> SettledStates(engine::GaitEngine& engine, const Task& task,
                                                       int count, std::uint64_t seed) {
  noise::Random random(MixSeeds(seed, 0));
  const engine::EngineInputs inputs = Inputs(task);
  std::vector<engine::EngineState> states;
  double until_s = kSettleS + task.speed_mps;
  for (int i = 0; i < count; ++i) {
    until_s += kBetweenStatesS + random.Uniform(0, 0.8);
    while (engine.Output().time_s < until_s) {
      engine.Advance(inputs);
      if (Fell(engine.Output())) {
        return Failure(std::string(stream::Name(task.gait)) + " at " +
                       std::to_string(task.speed_mps) +
                       " m/s falls with the gains to start from; start from a lower speed");
      }
    }
    states.push_back(engine.Save());
  }
  return states;
}

namespace {

/// Highest jump of a trial, m. Faster than 1 m/s it is lower than what is accepted: the built-in
/// tables were tuned so, and their commands write the same tables again.
double HighestJump(double speed_mps) {
  constexpr double kStandingM = 0.7, kFastM = 0.5, kStandingUpToMps = 1, kFastMps = 2;
  const double share = (speed_mps - kStandingUpToMps) / (kFastMps - kStandingUpToMps);
  return std::lerp(kStandingM, kFastM, std::clamp(share, 0.0, 1.0));
}

}  // namespace

Disturbance Draw(const Task& task, std::uint64_t seed) {
  noise::Random random(MixSeeds(seed, 1));
  if (task.paper) return DrawPaper(task, random);
  const double tested_ns = TestedKickNs(task.gait);
  Disturbance drawn{.kick_s = random.Uniform(1.5, 2.2),
                    .kick_ns = random.Uniform(tested_ns, kBeyondTest * tested_ns),
                    .kick_direction_rad = random.Uniform(-kPi, kPi)};
  const double turn_rad = DegreesToRadians(random.Uniform() < 0.5 ? kTurnDeg : -kTurnDeg);
  const double kind = random.Uniform();
  if (task.gait == Gait::kJump) {
    const double highest_m = HighestJump(task.speed_mps);
    const bool highest = random.Uniform() < 0.5;
    drawn.height_m = highest ? highest_m : random.Uniform(kLowestM, highest_m);
  }
  const Shares shares = SharesOf(task);
  if (kind < shares.pushed_turning) drawn.turn_rad = turn_rad;
  if (kind < shares.pushed) return drawn;
  drawn.kick_ns = kSmallKickNs;
  const Range widths = PitWidths(task);
  if (kind < shares.turning || widths.max == 0) {
    drawn.turn_rad = turn_rad;
    return drawn;
  }
  if (kind >= shares.pits && task.style) {
    return DrawStyled(task, kind - shares.pits, random, drawn);
  }
  if (kind >= shares.pits) {
    drawn.change_s = random.Uniform(kChangesS.min, kChangesS.max);
    drawn.change = {.gait = Gait::kWalk, .speed_mps = random.Uniform(kWalksMps.min, kWalksMps.max)};
    return drawn;
  }
  drawn.pit_m = random.Uniform(widths.min, widths.max);
  drawn.pit_ahead_m = task.speed_mps * random.Uniform(2.4, 3.0);
  return drawn;
}

bool ScoresHeading(const Disturbance& disturbance) {
  return disturbance.turn_rad != 0 && disturbance.kick_ns <= kSmallKickNs;
}

bool ScoresLegs(const Disturbance& disturbance) { return disturbance.kick_ns <= kSmallKickNs; }

namespace {

/// The pit's near edge, m along the track; hardly moving gaits are still at its start.
double PitEdge(const engine::EngineState& start, const Disturbance& disturbance) {
  return std::max(start.world.qpos[0] + disturbance.pit_ahead_m, terrain::kGroundAtStartM);
}

}  // namespace

std::string PitTrack(const engine::EngineState& start, const Disturbance& disturbance) {
  return R"({"version": 1, "name": "pit", "segments": [{"length_m": )" +
         std::to_string(PitEdge(start, disturbance)) + R"(}, {"length_m": )" +
         std::to_string(disturbance.pit_m) + R"(, "pit": true}, {"length_m": 1000}]})";
}

TrialResult RunTrial(engine::GaitEngine& engine, const engine::EngineState& start, const Task& task,
                     const Disturbance& disturbance) {
  engine::EngineInputs inputs = Inputs(task);
  inputs.features_number = start.inputs.features_number;
  inputs.push_number = start.inputs.push_number;
  inputs.direct_command.turn_per_step_rad = disturbance.turn_rad;
  inputs.direct_command.height_m = disturbance.height_m;
  const double near_m = PitEdge(start, disturbance);

  engine.Restore(start);
  GaitMeter meter(task);
  style::StyleMeter style_meter(kStepS);
  const int steps = StepsOf(disturbance.trial_s), kick_step = StepsOf(disturbance.kick_s);
  const int change_step = disturbance.change_s > 0 ? StepsOf(disturbance.change_s) : steps;
  const bool other_gait = disturbance.change.gait != task.gait;
  TrialResult result;
  for (int i = 0; i < steps; ++i) {
    if (i == kick_step) Kick(disturbance, inputs);
    if (i == change_step) {
      inputs.direct_command = disturbance.change;
      if (!other_gait) meter = GaitMeter({task.gait, disturbance.change.speed_mps});
    }
    if (disturbance.pit_m > 0 && task.gait == Gait::kRun) {
      const double to_edge_m = near_m - engine.Output().p_WC_m.x();
      const bool jumps = to_edge_m < kJumpLeadS * task.speed_mps && to_edge_m > -disturbance.pit_m;
      inputs.direct_command.gait = jumps ? Gait::kJump : Gait::kRun;
    }
    engine.Advance(inputs);
    if (Fell(engine.Output())) {
      result.survived = static_cast<double>(i) / steps;
      break;
    }
    if (i * kStepS >= disturbance.style_from_s) style_meter.Add(engine.Output());
    if (i < change_step || !other_gait) {
      meter.Add(engine.Output(), kStepS);
      continue;
    }
    result.reached = engine.Output().gait.gait == disturbance.change.gait;
    if (result.latency_s == 0 && (result.reached || i + 1 == steps)) {
      result.latency_s = (i + 1 - change_step) * kStepS;
    }
  }
  meter.Report(result);
  result.style = style_meter.Report();
  result.steady = disturbance.change_s == 0;
  if (!ScoresHeading(disturbance)) result.heading_error_rad = 0;
  if (!ScoresLegs(disturbance)) result.leg_gap_m = INFINITY;
  result.height_m = disturbance.height_m;
  return result;
}

namespace {

constexpr double kWindowS = 0.5;
constexpr double kChatterS = 0.02;

}  // namespace

void GaitMeter::Watch(Contact& contact, bool down, double time_s) {
  if (!contact.known || down == contact.down) {
    contact.known = true;
    contact.down = down;
    contact.changed_s = -1;
    return;
  }
  if (contact.changed_s < 0) contact.changed_s = time_s;
  if (time_s - contact.changed_s < kChatterS) return;
  if (contact.since_s >= 0) {
    (contact.down ? stance_s_ : flight_s_).Add(contact.changed_s - contact.since_s);
  }
  contact = {.known = true, .down = down, .since_s = contact.changed_s};
}

void GaitMeter::AddStride(const engine::EngineOutput& output) {
  if (output.gait.steps == steps_) return;
  const bool both = task_.gait == stream::Gait::kJump;
  const double now_m = output.gait.distance_m;
  if (step_m_ >= 0) stride_m_.Add((now_m - step_m_) * (both ? 1 : 2));
  step_m_ = steps_ == 0 ? -1 : now_m;
  steps_ = output.gait.steps;
}

void GaitMeter::Add(const engine::EngineOutput& output, double step_s) {
  if (time_s_ == 0) mean_speed_mps_ = task_.speed_mps;
  time_s_ += step_s;
  mean_speed_mps_ += step_s / kWindowS * (output.gait.speed_mps - mean_speed_mps_);
  const double error_mps = mean_speed_mps_ - task_.speed_mps;
  squared_error_.Add(error_mps * error_mps);
  const Eigen::Vector3d ahead = output.links[0].orientation * Eigen::Vector3d::UnitX();
  const double heading_error_rad =
      WrapAngle(std::atan2(ahead.y(), ahead.x()) - output.gait.heading_rad);
  squared_heading_error_.Add(heading_error_rad * heading_error_rad);
  const bool left = output.contacts[0].touching, right = output.contacts[1].touching;
  if (task_.gait == stream::Gait::kRun || task_.gait == stream::Gait::kJump) {
    Watch(contacts_[0], left || right, time_s_);
  } else {
    Watch(contacts_[0], left, time_s_);
    Watch(contacts_[1], right, time_s_);
  }
  AddStride(output);
  leg_gap_m_ = std::min(leg_gap_m_, legs::LegGap(output));
}

void GaitMeter::Report(TrialResult& result) const {
  result.speed_error_mps = std::sqrt(squared_error_.value());
  result.heading_error_rad = std::sqrt(squared_heading_error_.value());
  result.flight_s = flight_s_.value();
  result.stance_s = stance_s_.value();
  result.stride_m = stride_m_.value();
  result.leg_gap_m = leg_gap_m_;
}

}  // namespace footing::tune
