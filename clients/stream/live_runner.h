#pragma once

#include <cstdint>
#include <memory>

#include "clients/stream/plan.h"
#include "clients/stream/runner.h"
#include "common/virtual/devices/hand_motion.h"
#include "footing/v1/session.pb.h"

namespace footing::stream_client {

/// A Runner's two hands as their sensors feel them. Its clock is that of its devices.
class LiveRunner {
 public:
  explicit LiveRunner(std::uint64_t seed);

  /// What footing-sim publishes of the character and its track.
  void See(const v1::Tick& tick);
  /// The hands at t_s since the motion began; a time before the last one gives the last ones.
  wrists::Hands At(double t_s);

 private:
  Runner runner_;
  wrists::HandMotion unit_;  ///< One cycle a second of 1 m/s2.
  RunnerSwing swing_;        ///< As it is now, on its way to what is wanted.
  double cycles_ = 0;
  double time_s_ = 0;
};

/// The two Wiimotes of a synthetic player, and who moves them.
struct RunnerPlan {
  Plan plan;
  std::shared_ptr<LiveRunner> runner;
};
Result<RunnerPlan> PlanRunner(const Common& common);

}  // namespace footing::stream_client
