#include "daemon/simulation/reconstruction/standing_rise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/simulation/reconstruction/made_world.h"

namespace footing::reconstruction {
namespace {

std::array<HandInput, kHands> HandsAt(double forward_m) {
  std::array<HandInput, kHands> hands;
  for (std::size_t side = 0; side < kHands; ++side) {
    hands[side] = {true, {forward_m, side == 0 ? 0.7 : -0.7, 1.4}, Eigen::Vector3d::Constant(0.01)};
  }
  return hands;
}

TEST(StandingRise, FeetAreFlatInTheTPoseAndAsUsualOnceTheHandsHaveLeftIt) {
  const FootSpread usual;
  StandingRise rise;
  const auto advance = [&](double forward_m) { return rise.Advance(HandsAt(forward_m), usual); };
  const FootSpread flat = advance(0);
  EXPECT_EQ(flat.ankle_rise, 0);
  EXPECT_EQ(flat.toe_rise, 0);
  EXPECT_EQ(flat.ankle_up, usual.flat_up);
  const double left = 1 - std::exp(-0.2 / usual.leave_m);
  EXPECT_NEAR(advance(0.2).ankle_rise, left * usual.ankle_rise, 1e-9);
  EXPECT_NEAR(advance(3).toe_rise, usual.toe_rise, 1e-4);
  EXPECT_NEAR(advance(0).toe_rise, usual.toe_rise, 1e-4) << "they do not become flat again";
  rise.Start();
  EXPECT_EQ(advance(1).ankle_rise, 0) << "the hands of another T-pose";
}

TEST(StandingRise, HandsThatNobodySeesInTheTPoseSayNothing) {
  const FootSpread usual;
  StandingRise rise;
  std::array<HandInput, kHands> hands = HandsAt(0);
  hands[0].valid = false;
  const FootSpread spread = rise.Advance(hands, usual);
  EXPECT_EQ(spread.ankle_rise, usual.ankle_rise);
  EXPECT_GE(spread.ankle_up, usual.ankle_up);
}

TEST(Reconstruction, InTheTPoseTheKneesAreStraight) {
  World world;
  Reconstruction reconstruction = world.Made(world.AtRate());
  const auto knee_rad = [&](const std::vector<Eigen::Matrix3d>& R_WJ) {
    const auto knee = static_cast<std::size_t>(world.person.landmarks[body::Landmark::kLeftKnee]);
    const auto thigh = static_cast<std::size_t>(world.person.skeleton.joints[knee].parent);
    return std::acos(((R_WJ[thigh].transpose() * R_WJ[knee]).trace() - 1) / 2);
  };
  double off_rad = 0;
  const auto last = static_cast<std::size_t>(kMadeStandS * kMadeRateHz);
  for (std::size_t i = 0; i < last; ++i) {
    reconstruction.Advance(world.inputs[i]);
    world.ErrorM(reconstruction.output(), i, 0);
    off_rad = knee_rad(reconstruction.output().R_WJ) - knee_rad(world.at.R_WJ);
  }
  EXPECT_NEAR(off_rad, 0, 0.1);
}

}  // namespace
}  // namespace footing::reconstruction
