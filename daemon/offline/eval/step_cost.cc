#include "daemon/offline/eval/step_cost.h"

#include <algorithm>
#include <vector>

#include "common/runtime/clock.h"
#include "common/base/quantile.h"
#include "daemon/offline/eval/gait_trial.h"
#include "daemon/simulation/engine/state.h"

namespace footing::eval {
namespace {

constexpr int kWarmUpSteps = 5000;
constexpr int kSteps = 2000;
constexpr double kStepS = 0.001;
constexpr int kPairs = 7;
constexpr int kPublishEvery = 10;

struct Forces {
  physics::JointEfforts joints;
  Eigen::Vector3d push_W_n;
};

std::int64_t TimeEngine(engine::GaitEngine& engine, const engine::EngineState& start,
                        const engine::EngineInputs& inputs) {
  engine.Restore(start);
  const std::int64_t begin_ns = clock::ThreadCpuNs();
  for (int i = 0; i < kSteps; ++i) {
    engine.Advance(inputs);
    if (i % kPublishEvery == 0) engine.Output();
  }
  return clock::ThreadCpuNs() - begin_ns;
}

std::int64_t TimeBare(physics::World& world, const physics::WorldState& start,
                      const std::vector<Forces>& forces) {
  world.Restore(start);
  const std::int64_t begin_ns = clock::ThreadCpuNs();
  for (const Forces& force : forces) world.StepBare(force.joints, force.push_W_n);
  return clock::ThreadCpuNs() - begin_ns;
}

/// How much level ground there is first, m.
double LevelLength(const biped::GaitCommand& command, const GroundKind& kind) {
  constexpr double kStandsOnM = 2, kBeforePitM = 1;
  const double until_m = command.speed_mps * kStepS * (kWarmUpSteps + kSteps);
  if (kind.pit_m > 0) return until_m + kBeforePitM;
  if (kind.step_m != 0) return until_m - command.speed_mps * kStepS * kSteps / 2;
  return kStandsOnM;
}

}  // namespace

Result<double> MeasureStepCostRatio(const biped::GaitCommand& command, const GroundKind& kind) {
  const std::optional<std::string> track = MakeShortTrack(kind, LevelLength(command, kind));
  Result<engine::GaitEngine> engine = track ? NewEngineOn(*track) : NewEngine();
  if (!engine) return engine.error();
  Result<physics::World> world = NewWorld(track);
  if (!world) return world.error();
  Walker walker(*engine);
  walker.Command(command);
  for (int i = 0; i < kWarmUpSteps; ++i) walker.Advance();

  const engine::EngineState start = engine->Save();
  std::vector<Forces> forces;
  for (int i = 0; i < kSteps; ++i) {
    const engine::EngineOutput& output = walker.Advance();
    forces.push_back({output.joint_efforts, output.push_W_n});
  }
  const std::uint64_t expected = engine->Output().state_hash;

  std::vector<double> ratios;
  for (int pair = 0; pair < kPairs; ++pair) {
    std::int64_t ours_ns = TimeEngine(*engine, start, walker.inputs());
    std::int64_t bare_ns = TimeBare(*world, start.world, forces);
    bare_ns += TimeBare(*world, start.world, forces);
    if (world->StateHash() != expected) {
      return Failure("bare mj_step ended in another state than the engine");
    }
    ours_ns += TimeEngine(*engine, start, walker.inputs());
    ratios.push_back(static_cast<double>(ours_ns) / static_cast<double>(bare_ns));
  }
  return text::Median(std::move(ratios));
}

}  // namespace footing::eval
