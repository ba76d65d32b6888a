#include "daemon/offline/eval/gait_ground.h"

#include <algorithm>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/text.h"
#include "common/runtime/clock.h"
#include "daemon/offline/eval/gait_trial.h"
#include "daemon/simulation/engine/state.h"

namespace footing::eval {
namespace {

constexpr double kWidthM = 12;  ///< Nobody steers: there is space to drift.
constexpr double kBehindM = 500;
constexpr double kGroundUprightS = 1;
constexpr double kSettlingS = 5;
constexpr double kKickWithinM = 3;
constexpr double kKickWithinS = 1;
/// A fall from here on, before an edge, is a fall at the edge.
constexpr double kBeforeEdgeM = 0.5;
/// Gaits slower than this are led on to the course, this far, at this speed.
constexpr double kInPlaceMps = 0.1;
constexpr double kLeadInM = 2;
constexpr double kLeadInMps = 0.6;

std::string TrackText(const char* name, nlohmann::json segments) {
  return nlohmann::json{
      {"version", 1}, {"name", name}, {"width_m", kWidthM}, {"segments", std::move(segments)}}
      .dump();
}

}  // namespace

GroundCourse MakeStepCourse(double step_m, double length_m, Random& random) {
  GroundCourse course;
  double x_m = random.Uniform(4, 5);
  nlohmann::json segments = {{{"length_m", x_m}}};
  double rise_m = step_m;
  while (x_m < length_m) {
    course.edges_m.push_back(x_m);
    const double spacing_m = random.Uniform(2.5, 4);
    segments.push_back({{"length_m", spacing_m}, {"step_m", rise_m}});
    x_m += spacing_m;
    rise_m = random.Uniform(0, 1) < 0.5 ? step_m : -step_m;
  }
  segments.back()["length_m"] = kBehindM;
  course.track = TrackText("steps", std::move(segments));
  return course;
}

GroundCourse MakeSlopeCourse(double slope_deg, double speed_mps, double length_m, Random& random) {
  const double run_up_m = 4 + 2 * speed_mps + random.Uniform(0, 2);
  return {TrackText("slope", {{{"length_m", run_up_m}},
                              {{"length_m", length_m + kBehindM}, {"slope_deg", slope_deg}}}),
          {run_up_m}};
}

std::optional<std::string> MakeShortTrack(const GroundKind& kind, double level_m) {
  constexpr double kStepLastsM = 3;
  nlohmann::json segments = {{{"length_m", level_m}}};
  if (kind.step_m != 0) {
    segments.push_back({{"length_m", kStepLastsM}, {"step_m", kind.step_m}});
    segments.push_back({{"length_m", kBehindM}, {"step_m", -kind.step_m}});
  } else if (kind.slope_deg != 0) {
    segments.push_back({{"length_m", kBehindM}, {"slope_deg", kind.slope_deg}});
  } else if (kind.pit_m > 0) {
    segments.push_back({{"length_m", kind.pit_m}, {"pit", true}});
    segments.push_back({{"length_m", kBehindM}});
  } else {
    return std::nullopt;
  }
  return TrackText("short", std::move(segments));
}

GroundPilot::GroundPilot(const GroundCourse& course, const biped::GaitCommand& command,
                         Random& random)
    : course_(course),
      command_(command),
      kick_m_(course.edges_m.front() + random.Uniform(0, kKickWithinM)),
      kick_delay_s_(random.Uniform(0, kKickWithinS)) {
  reached_s_.reserve(course.edges_m.size());
}

biped::GaitCommand GroundPilot::Command(const engine::EngineOutput& output) {
  const double x_m = output.p_WC_m.x();
  const bool in_place = command_.speed_mps < kInPlaceMps;
  const double arrives_m = course_.edges_m.front() + (in_place ? kLeadInM : 0);
  if (!arrived_s_ && x_m > arrives_m) arrived_s_ = output.time_s;
  const double there_s = arrived_s_ ? output.time_s - *arrived_s_ : 0;
  settled_ = there_s > kSettlingS;
  kick_due_ = kick_due_ || x_m > kick_m_ || there_s > kSettlingS - 1 + kick_delay_s_;

  const std::size_t next = static_cast<std::size_t>(crossed_) + reached_s_.size();
  if (next < course_.edges_m.size() && x_m > course_.edges_m[next] - kBeforeEdgeM) {
    reached_s_.push_back(output.time_s);
  }
  const bool beyond =
      !reached_s_.empty() && x_m > course_.edges_m[static_cast<std::size_t>(crossed_)];
  if (beyond && output.time_s - reached_s_.front() > kGroundUprightS) {
    reached_s_.erase(reached_s_.begin());
    ++crossed_;
  }
  if (!in_place || arrived_s_) return command_;
  return {.gait = stream::Gait::kWalk, .speed_mps = kLeadInMps};
}

namespace {

constexpr int kWarmUpSteps = 5000;
constexpr int kSteps = 2000;
constexpr double kStepS = 0.001;
constexpr int kPairs = 7;
constexpr int kPublishEvery = 10;

/// How much level ground there is first, m.
double LevelLength(const biped::GaitCommand& command, const GroundKind& kind) {
  constexpr double kStandsOnM = 2, kBeforePitM = 1;
  const double until_m = command.speed_mps * kStepS * (kWarmUpSteps + kSteps);
  if (kind.pit_m > 0) return until_m + kBeforePitM;
  if (kind.step_m != 0) return until_m - command.speed_mps * kStepS * kSteps / 2;
  return kStandsOnM;
}

}  // namespace

Result<StepCost> StepCost::Create(const biped::GaitCommand& command, const GroundKind& kind,
                                  double push_ns) {
  const std::optional<std::string> track = MakeShortTrack(kind, LevelLength(command, kind));
  Result<engine::GaitEngine> engine =
      track ? NewEngineOn(*track, kind.surface) : NewEngine(kind.surface);
  if (!engine) return engine.error();
  Result<physics::World> world = NewWorld(track, kind.surface);
  if (!world) return world.error();
  StepCost cost(std::move(*engine), std::move(*world));
  Walker walker(cost.engine_);
  walker.Command(command);
  for (int i = 0; i < kWarmUpSteps; ++i) walker.Advance();
  if (push_ns > 0) walker.Push(push_ns, kPi / 2);
  cost.inputs_ = walker.inputs();
  cost.start_ = cost.engine_.Save();
  for (int i = 0; i < kSteps; ++i) {
    const engine::EngineOutput& output = walker.Advance();
    cost.forces_.push_back({output.joint_efforts, output.push_W_n});
  }
  cost.fell_ = walker.fell();
  cost.hash_ = cost.engine_.Output().state_hash;
  return cost;
}

double StepCost::EngineUs() {
  engine_.Restore(start_);
  const std::int64_t begin_ns = clock::ThreadCpuNs();
  for (int i = 0; i < kSteps; ++i) {
    engine_.Advance(inputs_);
    if (i % kPublishEvery == 0) engine_.Output();
  }
  return static_cast<double>(clock::ThreadCpuNs() - begin_ns) * 1e-3 / kSteps;
}

double StepCost::BareUs() {
  world_.Restore(start_.world);
  const std::int64_t begin_ns = clock::ThreadCpuNs();
  for (const Forces& force : forces_) world_.StepBare(force.joints, force.push_W_n);
  return static_cast<double>(clock::ThreadCpuNs() - begin_ns) * 1e-3 / kSteps;
}

Result<double> MeasureStepCostRatio(const biped::GaitCommand& command, const GroundKind& kind) {
  Result<StepCost> cost = StepCost::Create(command, kind);
  if (!cost) return cost.error();
  if (cost->fell()) return 0;  // Bare mj_step puts no character back.
  std::vector<double> ratios;
  for (int pair = 0; pair < kPairs; ++pair) {
    double ours_us = cost->EngineUs(), bare_us = cost->BareUs();
    bare_us += cost->BareUs();
    if (!cost->agrees()) return Failure("bare mj_step ended in another state than the engine");
    ours_us += cost->EngineUs();
    ratios.push_back(ours_us / bare_us);
  }
  return text::Median(std::move(ratios));
}

}  // namespace footing::eval
