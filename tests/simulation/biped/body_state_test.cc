#include <cmath>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/biped/model.h"
#include "tests/simulation/test_world.h"

namespace footing::biped {
namespace {

TEST(Biped, HasThePapersMassesAndInertias) {
  const BipedParameters p = test::Biped();  // Figure 4.
  EXPECT_EQ(p.body_mass_kg, 9);
  EXPECT_EQ(p.body_inertia_roll_kgm2, 0.5);
  EXPECT_EQ(p.body_inertia_pitch_kgm2, 1.2);
  EXPECT_EQ(p.body_inertia_yaw_kgm2, 1.0);
  EXPECT_EQ(p.link_mass_kg, 1);
  EXPECT_EQ(p.link_inertia_across_kgm2, 0.1);
  EXPECT_EQ(p.link_inertia_along_kgm2, 0.001);
}

TEST(Biped, StateKnowsWhereTheFeetAre) {
  const BipedParameters p = test::Biped();
  physics::World world = test::LevelWorld();
  std::array<double, physics::kJoints> joints{};
  joints[1] = 0.2;   // Left roll about x moves the foot to +y: sin(0.2) times the length.
  joints[6] = -0.3;  // Right pitch about y, negative, moves the foot forward.
  joints[7] = -0.1;
  world.Reset({1, 2, 3}, 0, joints);
  const BodyState state = Read(p, world.Observe(), 0);
  EXPECT_NEAR(state.legs[kLeft].p_WF.y() - 2, p.hip_half_spacing_m + std::sin(0.2), 1e-9);
  EXPECT_NEAR(state.legs[kRight].p_WF.x() - 1, 0.9 * std::sin(0.3), 1e-9);
  EXPECT_NEAR(state.legs[kRight].length_m, 0.9, 1e-12);
  EXPECT_NEAR((state.legs[kRight].p_WF - state.legs[kRight].p_WH).norm(), 0.9, 1e-9);
}

TEST(Biped, HingeAxesAreThoseOfTheJoints) {
  const BipedParameters p = test::Biped();
  physics::World world = test::LevelWorld();
  std::array<double, physics::kJoints> joints{0.3, 0.2, -0.4, 0, 0, 0, 0, 0};
  world.Reset({0, 0, 3}, 0.5, joints);
  const LegState leg = Read(p, world.Observe(), 0).legs[kLeft];
  const double d = 1e-6;
  for (std::size_t j = 0; j < 3; ++j) {
    auto turned = joints;
    turned[j] += d;
    world.Reset({0, 0, 3}, 0.5, turned);
    const LegState after = Read(p, world.Observe(), 0).legs[kLeft];
    const Eigen::Vector3d moved = (after.p_WF - leg.p_WF) / d;
    const Eigen::Vector3d expected =
        leg.hinge_axes_W.col(static_cast<int>(j)).cross(leg.p_WF - leg.p_WH);  // w x r
    EXPECT_LT((moved - expected).norm(), 1e-5) << "joint " << j;
  }
}

TEST(Biped, SkeletonNamesFiveLinksAndTwoFeet) {
  const stream::Skeleton skeleton = DescribeSkeleton(test::Biped());
  ASSERT_EQ(skeleton.links.size(), 5u);
  EXPECT_EQ(skeleton.links[4].name, "right_knee");
  EXPECT_EQ(skeleton.links[4].parent, 3);
  EXPECT_EQ(skeleton.contact_points, (std::vector<std::string>{"left_foot", "right_foot"}));
}

TEST(Biped, RefusesAFileWithAWrongOrMissingOrUnknownKey) {
  const std::string good = test::DataFile("biped.json");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return ParseBiped(text, "biped.json");
  };
  for (const auto& [from, to, what] :
       {std::array<std::string, 3>{"9.0", "-9.0", "body_mass_kg"},
        {"\"foot_radius_m\"", "\"foot_radius\"", "unknown key foot_radius"},
        {"\"leg_length_m\": 1.0", "\"leg_length_m\": 1.9", "leg_length_m"}}) {
    const auto parsed = with(from, to);
    ASSERT_FALSE(parsed.ok()) << what;
    EXPECT_NE(parsed.error().message.find(what), std::string::npos) << parsed.error().message;
  }
}

using stream::Gait;

TEST(Limits, KeepCommandsInTheStableRange) {
  EXPECT_EQ(Limited({.gait = Gait::kWalk, .speed_mps = 9}).speed_mps, 1.75);
  EXPECT_EQ(Limited({.gait = Gait::kRun, .speed_mps = -1}).speed_mps, 0);
  EXPECT_EQ(Limited({.gait = Gait::kJump, .height_m = 3}).height_m, 0.7);
  EXPECT_EQ(Limited({.gait = Gait::kJump, .speed_mps = 2, .height_m = 3}).height_m, 0.7);
  EXPECT_EQ(Limited({.gait = Gait::kRun, .speed_mps = NAN}).gait, Gait::kStep);
  EXPECT_EQ(Limited({.gait = Gait::kUnspecified, .speed_mps = 1}).gait, Gait::kStep);
}

TEST(Limits, ALeapFasterThanJumpsAreTurnsLess) {
  EXPECT_DOUBLE_EQ(TurnLimit(Gait::kJump, 2), DegreesToRadians(kTurnPerStepMaxDeg));
  // The same sideways speed of the landing: 8 degrees at 2 m/s, 4 at 4.
  EXPECT_DOUBLE_EQ(TurnLimit(Gait::kJump, 4), DegreesToRadians(kTurnPerStepMaxDeg / 2));
}

TEST(Limits, AFasterRunTurnsLess) {
  const double slow_rad = TurnLimit(Gait::kRun, 3), fast_rad = TurnLimit(Gait::kRun, 6);
  EXPECT_DOUBLE_EQ(slow_rad, DegreesToRadians(kTurnPerStepMaxDeg));
  EXPECT_DOUBLE_EQ(fast_rad, DegreesToRadians(5));
  EXPECT_NEAR(TurnLimit(Gait::kRun, 5), (slow_rad + fast_rad) / 2, 1e-12);
  for (const double sign : {1.0, -1.0}) {
    const GaitCommand sharp{.gait = Gait::kRun, .speed_mps = 9, .turn_per_step_rad = sign};
    EXPECT_DOUBLE_EQ(Limited(sharp).turn_per_step_rad, sign * fast_rad);
  }
}

TEST(Limits, KeepWhatTheyDoNotLimit) {
  const GaitCommand command{.gait = Gait::kWalk,
                            .speed_mps = 1,
                            .height_m = 0.2,
                            .turn_per_step_rad = 0.05,
                            .cadence_hz = 2.5};
  EXPECT_EQ(Limited(command), command);
}

}  // namespace
}  // namespace footing::biped
