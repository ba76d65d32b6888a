#include "daemon/simulation/reconstruction/hand_track.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/body/skeleton_points.h"
#include "common/virtual/devices/random.h"

namespace footing::reconstruction {
namespace {

constexpr double kHandTrackStepS = 1.0 / 30;
const Eigen::Vector3d kSdM = Eigen::Vector3d::Constant(0.02);

TEST(HandTrack, AJointIsFollowedAsSlowerThanAHand) {
  HandTrack hand;
  HandTrack joint = JointTracks()[body::IndexOf(stream::BodyJoint::kLeftElbow)];
  for (HandTrack* track : {&hand, &joint}) {
    for (int i = 0; i < 60; ++i) {
      track->Add(i / 30.0, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Constant(0.02));
    }
  }
  const double late_s = 59 / 30.0 + 0.1;
  const double hand_sd_m = hand.At(late_s).sd_m.x(), joint_sd_m = joint.At(late_s).sd_m.x();
  EXPECT_GT(joint_sd_m, 0.02);
  EXPECT_LT(joint_sd_m, 0.75 * hand_sd_m);
}

TEST(HandTrack, IsInvalidBeforeTheFirstPlaceAndThenThere) {
  HandTrack track;
  EXPECT_FALSE(track.At(1).valid);
  track.Add(1, {0.1, -0.8, 1.4}, kSdM);
  EXPECT_TRUE(track.At(1).valid);
  EXPECT_EQ(track.At(1).p_W_m, Eigen::Vector3d(0.1, -0.8, 1.4));
  EXPECT_LT((track.At(1).sd_m - kSdM).norm(), 1e-12);
  EXPECT_EQ(track.At(0.5).p_W_m, track.At(1).p_W_m) << "never before what was told";
}

TEST(HandTrack, CarriesASteadyHandOnOverTheDelay) {
  HandTrack track;
  const Eigen::Vector3d speed_mps(1, -0.5, 0.2);
  double t_s = 0;
  for (; t_s < 1; t_s += kHandTrackStepS) track.Add(t_s, t_s * speed_mps, kSdM);
  t_s -= kHandTrackStepS;
  const HandInput now = track.At(t_s + 0.08);
  // Of 9 cm; it is thought to slow down.
  EXPECT_LT((now.p_W_m - (t_s + 0.08) * speed_mps).norm(), 0.03);
  EXPECT_GT(now.sd_m.minCoeff(), kSdM.x());
  EXPECT_GT(track.At(t_s + 0.2).sd_m.x(), now.sd_m.x());
  EXPECT_EQ(track.At(t_s + 5).p_W_m, track.At(t_s + HandTrack::kFurthestS).p_W_m);
}

TEST(HandTrack, OfADelaysErrorInASwingLittleMoreThanHalfIsLeft) {
  // A swing of 0.3 m at 0.8 Hz, told with 1.5 cm of noise and 83 ms late.
  noise::Random random(3);
  HandTrack track;
  constexpr double kLateS = 0.083, kOmega = 2 * 3.14159265358979 * 0.8;
  double carried = 0, left = 0;
  for (int i = 0; i < 3000; ++i) {
    const double t_s = i * kHandTrackStepS;
    const Eigen::Vector3d told(0.3 * std::sin(kOmega * t_s) + 0.015 * random.Normal(), 0, 1);
    track.Add(t_s, told, Eigen::Vector3d::Constant(0.043));
    const double truth_m = 0.3 * std::sin(kOmega * (t_s + kLateS));
    carried += std::pow(track.At(t_s + kLateS).p_W_m.x() - truth_m, 2);
    left += std::pow(told.x() - truth_m, 2);
  }
  EXPECT_LT(std::sqrt(carried), 0.65 * std::sqrt(left));
}

TEST(HandTrack, BeginsAnewAfterAPauseAndIgnoresWhatComesOutOfOrder) {
  HandTrack track;
  for (int i = 0; i < 10; ++i) track.Add(i * kHandTrackStepS, {0.1 * i, 0, 0}, kSdM);
  track.Add(0.2, {9, 9, 9}, kSdM);
  EXPECT_LT(track.At(0.3).p_W_m.norm(), 2);
  track.Add(5, {1, 2, 3}, kSdM);
  EXPECT_EQ(track.At(5.05).p_W_m, Eigen::Vector3d(1, 2, 3)) << "its speed is not known any more";
  track.Add(1, {3, 2, 1}, kSdM);  // Another clock.
  EXPECT_EQ(track.At(1).p_W_m, Eigen::Vector3d(3, 2, 1));
}

}  // namespace
}  // namespace footing::reconstruction
