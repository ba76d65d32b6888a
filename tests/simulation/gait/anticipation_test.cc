#include "daemon/simulation/gait/anticipation.h"

#include <cmath>

#include "daemon/simulation/gait/controller.h"
#include "tests/simulation/test_world.h"

namespace footing::gait {
namespace {

using stream::Gait;

/// A character that walks or runs, and is given a command at a moment of its cycle.
struct Scene {
  biped::BipedParameters biped = test::Biped();
  Gains gains;
  physics::World world = test::LevelWorld();
  GaitMemory memory = Standing(0, 0);
  double time_s = 0;
  bool fell = false;

  Scene() {
    const double leg_m = StandingLength(biped, gains);
    std::array<double, physics::kJoints> joints{};
    joints[3] = joints[7] = leg_m - biped.leg_length_m;
    world.Reset({0, 0, leg_m + biped.foot_radius_m}, 0, joints);
  }
  biped::BodyState Body() const { return biped::Read(biped, world.Observe(), time_s); }
  void Run(const biped::GaitCommand& command, double seconds) {
    for (const double end_s = time_s + seconds; time_s < end_s; time_s += world.step_s()) {
      world.Step(Advance(Body(), biped, gains, command, nullptr, world.step_s(), memory),
                 Eigen::Vector3d::Zero());
      fell = fell || Body().p_WB.z() < 0.55;
    }
  }
  double PitchRad() const { return -std::asin(Body().R_WB(2, 0)); }
};

constexpr double kFrameS = 1.0 / 60;
constexpr double kDegree = 0.017453292519943295;

/// Difference that a command makes to the body after `seconds`: pitch, and height.
struct Answer {
  double pitch_rad, height_m;
};
Answer AnswerOf(const biped::GaitCommand& before, const biped::GaitCommand& after, double moment_s,
                double seconds) {
  Scene without, with;
  without.Run(before, moment_s);
  with.Run(before, moment_s);
  without.Run(before, seconds);
  with.Run(after, seconds);
  const Answer answer{with.PitchRad() - without.PitchRad(),
                      with.Body().p_WB.z() - without.Body().p_WB.z()};
  with.Run(after, 3);
  EXPECT_FALSE(with.fell);
  return answer;
}

TEST(Anticipation, AWalkLeansForwardAtOnceForASpeedItMustStillGain) {
  const biped::GaitCommand slow{.gait = Gait::kWalk, .speed_mps = 0.4};
  const biped::GaitCommand fast{.gait = Gait::kWalk, .speed_mps = 1.4};
  for (const double moment_s : {4.0, 4.1, 4.2}) {
    EXPECT_GT(AnswerOf(slow, fast, moment_s, kFrameS).pitch_rad, 0.05 * kDegree);
    EXPECT_GT(AnswerOf(slow, fast, moment_s, 0.15).pitch_rad, 1 * kDegree);
    EXPECT_LT(AnswerOf(fast, slow, moment_s, 0.15).pitch_rad, -1 * kDegree);
  }
}

TEST(Anticipation, AWalkCrouchesWhileItWaitsToJump) {
  const biped::GaitCommand walk{.gait = Gait::kWalk, .speed_mps = 0.8};
  const biped::GaitCommand jump{.gait = Gait::kJump, .speed_mps = 0.8, .height_m = 0.2};
  double lowest_m = 0;
  for (const double moment_s : {4.0, 4.1, 4.2}) {
    lowest_m = std::min(lowest_m, AnswerOf(walk, jump, moment_s, 0.1).height_m);
  }
  EXPECT_LT(lowest_m, -0.01);
}

TEST(Anticipation, NothingShowsOfACommandThatIsObeyed) {
  Scene scene;
  const biped::GaitCommand walk{.gait = Gait::kWalk, .speed_mps = 0.8};
  scene.Run(walk, 4);
  const biped::BodyState body = scene.Body();
  const Context context{body, scene.biped, scene.gains, walk, nullptr, 0.001};
  EXPECT_EQ(AnticipatedLean(context, scene.memory), 0);
  EXPECT_EQ(AnticipatedCrouch(context, scene.memory), 0);
}

}  // namespace
}  // namespace footing::gait
