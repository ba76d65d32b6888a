#include "daemon/simulation/gait/momentum.h"

#include <cmath>

#include "tests/simulation/test_world.h"

namespace footing::gait {
namespace {

using Eigen::Vector3d;

TEST(AngularMomentum, OfABodyThatTurnsAsOneIsItsInertiaTimesItsRate) {
  const biped::BipedParameters biped = test::Biped();
  biped::BodyState body;
  const double hip_link_m = biped.hip_link_com_below_hip_m, half_m = biped.hip_half_spacing_m;
  const double length_m = 1.0, knee_link_m = length_m - biped.foot_below_knee_link_com_m;
  const double depth_m = 2 * (hip_link_m + knee_link_m) * biped.link_mass_kg / biped.mass_kg();
  const double roll_radps = 0.7;
  body.w_WB = {roll_radps, 0, 0};
  body.p_WC = {0, 0, -depth_m};
  body.v_WC = body.w_WB.cross(body.p_WC);
  for (int i = 0; i < 2; ++i) {
    body.legs[i].p_WH = {0, biped::Side(i) * half_m, 0};
    body.legs[i].length_m = length_m;
  }
  // Parallel axes: four links at the hips' spacing, at their depths below the whole COM.
  double inertia_kgm2 = biped.body_inertia_roll_kgm2 + biped.body_mass_kg * depth_m * depth_m;
  for (const double below_m : {hip_link_m, knee_link_m}) {
    const double arm_m = below_m - depth_m;
    inertia_kgm2 += 2 * (biped.link_inertia_across_kgm2 +
                         biped.link_mass_kg * (half_m * half_m + arm_m * arm_m));
  }
  EXPECT_NEAR(AngularMomentum(body, biped).x(), inertia_kgm2 * roll_radps, 1e-12);
}

TEST(AngularMomentum, StaysInFlightWhateverTheLegsDo) {
  biped::BipedParameters biped = test::Biped();
  biped.hip_armature_kgm2 = 0;  // The rotors' own momentum is left out.
  const char* plane = "<geom type='plane' contype='1' conaffinity='2' size='0 0 1'/>";
  physics::World world = std::move(physics::World::FromMjcf(
                                       biped::WriteMjcf(biped, plane, {}, 0.0002), biped::Names()))
                             .value();
  world.Reset({0, 0, 8}, 0, {});
  const auto momentum = [&] {
    return AngularMomentum(biped::Read(biped, world.Observe(), 0), biped);
  };
  for (int i = 0; i < 500; ++i) world.Step({}, {30, 60, 0});  // Above the whole COM: it turns.
  const Vector3d before = momentum();
  EXPECT_LT(before.x(), -0.3);
  for (int i = 0; i < 750; ++i) world.Step({0, 12, -8, 10, 0, -8, 6, -10}, Vector3d::Zero());
  EXPECT_LT((momentum() - before).norm(), 0.01 * before.norm());
  EXPECT_GT(std::fabs(world.Observe().joint_position[1]), 0.1);
}

}  // namespace
}  // namespace footing::gait
