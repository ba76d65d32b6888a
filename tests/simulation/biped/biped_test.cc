#include <cmath>

#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/biped/skeleton.h"
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

}  // namespace
}  // namespace footing::biped
