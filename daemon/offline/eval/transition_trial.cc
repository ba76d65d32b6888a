#include "daemon/offline/eval/transition_trial.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "common/base/units.h"
#include "daemon/simulation/gait/phase.h"

namespace footing::eval {
namespace {

using stream::Gait;

constexpr double kKickTimeS = 1.5;
constexpr double kTransitionKickNs = 2;
constexpr double kLatestReachS = 10;
constexpr double kTransitionUprightS = 5;
constexpr double kTransitionSettleS =
    4;  ///< Beyond the upright time, for the slew of the speed command.
constexpr double kSpeedToleranceMps = 0.1;

const char* const kTouchdownPhase = gait::Name(gait::RunningPhase::kCompression);

/// Mean speed over one whole second, a second after the next.
class SpeedPerSecond {
 public:
  void Add(double speed_mps, double step_s) {
    sum_m_ += speed_mps * step_s;
    time_s_ += step_s;
    if (time_s_ < 1) return;
    last_mps_ = sum_m_ / time_s_;
    sum_m_ = time_s_ = 0;
  }
  double last_mps() const { return last_mps_; }

 private:
  double sum_m_ = 0, time_s_ = 0, last_mps_ = 0;
};

/// Follows the first flight of jumping.
class LeapMeter {
 public:
  void Add(const engine::EngineOutput& output) {
    if (leap_ || (!flies_ && output.gait.gait != Gait::kJump)) return;
    if (!flies_) {
      flies_ = true;
      start_s_ = output.time_s;
      start_W_m_ = output.p_WC_m;
    }
    rise_m_ = std::max(rise_m_, output.p_WC_m.z() - start_W_m_.z());
    if (output.gait.phase != std::string_view(kTouchdownPhase)) return;
    leap_ = Leap{.flight_s = output.time_s - start_s_,
                 .length_m = (output.p_WC_m - start_W_m_).head<2>().norm(),
                 .rise_m = rise_m_,
                 .commanded_m = output.gait.commanded_height_m};
  }
  const std::optional<Leap>& leap() const { return leap_; }

 private:
  bool flies_ = false;
  double start_s_ = 0, rise_m_ = 0;
  Eigen::Vector3d start_W_m_ = Eigen::Vector3d::Zero();
  std::optional<Leap> leap_;
};

}  // namespace

biped::GaitCommand DrawCommand(Gait gait, Random& random) {
  biped::GaitCommand command;
  command.gait = gait;
  command.height_m = random.Uniform(0.1, 0.35);
  switch (gait) {
    case Gait::kWalk:
      command.speed_mps = random.Uniform(0.2, 1.4);
      break;
    case Gait::kRun:
      command.speed_mps = random.Uniform(1.5, 4.5);
      break;
    case Gait::kJump:
      command.speed_mps = random.Uniform(0, 1);
      break;
    case Gait::kStep:
    case Gait::kUnspecified:
      break;
  }
  return command;
}

Result<TransitionResult> RunTransition(Gait from, Gait to, std::uint64_t seed,
                                       const TransitionSpeeds& speeds) {
  Result<engine::GaitEngine> engine = NewEngine();
  if (!engine) return engine.error();
  Random random(seed);
  biped::GaitCommand before = DrawCommand(from, random);
  biped::GaitCommand after = DrawCommand(to, random);
  before.speed_mps = speeds.from_mps.value_or(before.speed_mps);
  after.speed_mps = speeds.to_mps.value_or(after.speed_mps);
  after.height_m = speeds.height_m.value_or(after.height_m);
  const double change_s = random.Uniform(7, 8.5);
  const double kick_rad = random.Uniform(-kPi, kPi);
  const double step_s = engine::EngineConfig{}.step_s;

  Walker walker(*engine);
  TransitionResult result;
  SpeedPerSecond speed;
  LeapMeter meter;
  double reached_s = -1;
  bool kicked = false, changed = false;
  for (double time_s = 0; !walker.fell();) {
    if (!kicked && time_s >= kKickTimeS) walker.Push(kTransitionKickNs, kick_rad);
    kicked = kicked || time_s >= kKickTimeS;
    changed = time_s >= change_s;
    walker.Command(changed ? after : before);
    const engine::EngineOutput& output = walker.Advance();
    time_s = output.time_s;
    speed.Add(output.gait.speed_mps, step_s);
    if (changed && to == Gait::kJump) meter.Add(output);
    if (changed && reached_s < 0 && output.gait.gait == to) reached_s = time_s;
    if (reached_s < 0 && time_s > change_s + kLatestReachS) break;
    const bool stayed = reached_s >= 0 && time_s > reached_s + kTransitionUprightS;
    result.succeeded = stayed && output.gait.gait == to &&
                       std::fabs(speed.last_mps() - after.speed_mps) <= kSpeedToleranceMps;
    if (result.succeeded ||
        (stayed && time_s > reached_s + kTransitionUprightS + kTransitionSettleS))
      break;
  }
  result.leap = meter.leap();
  result.fell = walker.fell();
  result.succeeded = result.succeeded && !result.fell;
  if (reached_s >= 0) result.latency_s = reached_s - change_s;
  return result;
}

}  // namespace footing::eval
