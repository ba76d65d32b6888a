#include <cmath>

#include "daemon/simulation/gait/controller.h"
#include "tests/simulation/test_world.h"

namespace footing::gait {
namespace {

using stream::Gait;

/// Steps a second from 4 s after the command on, over 6 s; 0 after a fall.
double MeasuredCadence(const biped::GaitCommand& command) {
  const biped::BipedParameters biped = test::Biped();
  const Gains gains;
  physics::World world = test::LevelWorld();
  const double leg_m = StandingLength(biped, gains), step_s = world.step_s();
  std::array<double, physics::kJoints> joints{};
  joints[3] = joints[7] = leg_m - biped.leg_length_m;
  world.Reset({0, 0, leg_m + biped.foot_radius_m}, 0, joints);
  GaitMemory memory = Standing(0, 0);
  double first_s = 0, last_s = 0;
  std::uint64_t first = 0, last = 0;
  for (int i = 0; i < 10000; ++i) {
    const biped::BodyState body = biped::Read(biped, world.Observe(), i * step_s);
    if (body.p_WB.z() < 0.55) return 0;
    // A kick of 2 N s to the side: a gait that only keeps its balance undisturbed does not count.
    const Eigen::Vector3d push_W_n(0, i >= 3000 && i < 3100 ? 20 : 0, 0);
    world.Step(Advance(body, biped, gains, command, nullptr, step_s, memory), push_W_n);
    if (i < 4000 || memory.steps == last) continue;
    last = memory.steps;
    last_s = i * step_s;
    if (first_s == 0) first = last, first_s = last_s;
  }
  return static_cast<double>(last - first) / (last_s - first_s);
}

TEST(Cadence, WalkingStepsAtTheUsersRate) {
  for (const double cadence_hz : {2.3, 2.6, 2.9}) {
    const biped::GaitCommand command{
        .gait = Gait::kWalk, .speed_mps = 0.8, .cadence_hz = cadence_hz};
    EXPECT_NEAR(MeasuredCadence(command), cadence_hz, 0.05 * cadence_hz);
  }
}

TEST(Cadence, RunningStepsAtTheUsersRate) {
  for (const double cadence_hz : {2.1, 2.3, 2.5}) {
    const biped::GaitCommand command{
        .gait = Gait::kRun, .speed_mps = 2.5, .cadence_hz = cadence_hz};
    EXPECT_NEAR(MeasuredCadence(command), cadence_hz, 0.05 * cadence_hz);
  }
}

TEST(Cadence, BeyondTheRobustRangeItIsFollowedAsFarAsThat) {
  const biped::GaitCommand hasty{.gait = Gait::kWalk, .speed_mps = 0.8, .cadence_hz = 9};
  const Gains gains;
  const double fastest_hz =
      1 / (gains.cadence.swing_time_min_s + gains.walking.double_support_time_s);
  EXPECT_NEAR(MeasuredCadence(hasty), fastest_hz, 0.05 * fastest_hz);
}

}  // namespace
}  // namespace footing::gait
