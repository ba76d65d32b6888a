#include "daemon/offline/learning/own_take.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/body/kinematics.h"
#include "daemon/offline/learning/pose_regression.h"
#include "tests/offline/learning/made_take.h"

namespace footing::learning {
namespace {

constexpr double kOffsetS = 1.5, kDrift = 60e-6;

/// Performing takes a while: once for all tests.
const MadeTake& Made() {
  static const MadeTake made = MakeTake({.offset_s = kOffsetS, .drift = kDrift});
  return made;
}

const OwnTake& Take() {
  static const OwnTake take =
      MakeOwnTake(Made().session, Made().motion, Made().body, "me.bvh").value();
  return take;
}

/// A basis of the motion's own poses.
reconstruction::Models Basis() {
  const motion::Motion& motion = Take().motion;
  std::vector<std::string> dofs = body::DofNames(motion.skeleton);
  Eigen::MatrixXd poses = motion.q;
  poses.topRows<2>().setZero();
  model::Model model{.kind = "basis", .provenance = {}, .tensors = {}};
  AppendTensors(MakeBasis(poses, dofs), model);
  return reconstruction::MakeModels({{"made", model}}).value();
}

TEST(MakeOwnTake, PutsRecordingAndMotionOnOneClock) {
  const TimeAlignment& at = Take().alignment;
  EXPECT_EQ(at.stomps_both, 3);
  const double end_s = Made().motion.duration_s();
  for (const double t_s : {0.0, end_s}) {
    EXPECT_NEAR(at.ToRecording(t_s), kOffsetS + (1 + kDrift) * t_s, 0.004);
  }
  EXPECT_NEAR(Take().t_pose.mass_kg, kMadeMassKg, 0.2);
  EXPECT_NEAR(Take().body.mass_kg, kMadeMassKg, 0.2);
}

TEST(MakeOwnTake, LaysTheMotionOnTheBoardsFloor) {
  // THEN in the T-pose the middle of the ankles is over the middle of the boards, as it was.
  body::Kinematics at(Take().body.skeleton);
  body::ComputeKinematics(Take().body.skeleton, Take().motion.q.col(0), at);
  const auto ankle = [&](body::Landmark landmark) {
    return at.p_WJ[static_cast<std::size_t>(Take().body.landmarks[landmark])];
  };
  const Eigen::Vector3d left = ankle(body::Landmark::kLeftAnkle);
  const Eigen::Vector3d right = ankle(body::Landmark::kRightAnkle);
  EXPECT_NEAR(left.y() + right.y(), 0, 0.01);
  EXPECT_NEAR(left.x(), right.x(), 0.01) << "faces x";
  EXPECT_GT(left.y() - right.y(), 0.1);
  EXPECT_LT(Take().placement.rms_m, 0.01);
}

TEST(MakeOwnTake, IsRefusedWithTheBoardsExchanged) {
  MadeTake exchanged = Made();
  std::swap(exchanged.session.cells_W_m[0], exchanged.session.cells_W_m[1]);
  const auto take = MakeOwnTake(exchanged.session, exchanged.motion, exchanged.body, "me.bvh");
  ASSERT_FALSE(take);
  EXPECT_NE(take.error().message.find("were left and right changed"), std::string::npos)
      << take.error().message;
}

TEST(MakeOwnTake, IsRefusedWithoutATPose) {
  MadeTake late = Made();
  for (auto& board : late.session.boards) {
    std::erase_if(board, [](const BoardReading& reading) { return reading.time_s < 6; });
  }
  const auto take = MakeOwnTake(late.session, late.motion, late.body, "me.bvh");
  ASSERT_FALSE(take);
  EXPECT_EQ(take.error().kind, ErrorKind::kInvalidData);
  EXPECT_NE(take.error().message.find("begin with the T-pose"), std::string::npos);
}

TEST(OwnLoads, AreTheMeasuredWeightBesideTheMotionsCom) {
  const auto clips = OwnLoads(Take());
  ASSERT_EQ(clips.size(), 1u);
  EXPECT_NEAR(static_cast<double>(clips[0].size()) / 60, Made().motion.duration_s(), 0.05);
  // In the T-pose the COM is over the COP, which is where both are counted from.
  for (std::size_t i = 60; i < 240; i += 20) {
    double weight = 0;
    for (const double load : clips[0][i].load) weight += load;
    EXPECT_NEAR(weight, 1, 0.02);
    EXPECT_LT((*Cop(clips[0][i]) - clips[0][i].c_W_m).norm(), 0.015);
  }
  EXPECT_LT(CopError(clips[0]).maxCoeff(), 0.06);
}

TEST(OwnLoads, OfTheMirrorImageAreMirrored) {
  const auto image = MirrorImage(Take());
  ASSERT_TRUE(image) << image.error().message;
  const auto clips = OwnLoads(Take()), mirrored = OwnLoads(*image);
  ASSERT_EQ(clips[0].size(), mirrored[0].size());
  for (std::size_t i = 0; i < clips[0].size(); i += 50) {
    EXPECT_NEAR(clips[0][i].c_W_m.x(), mirrored[0][i].c_W_m.x(), 2e-3);
    EXPECT_NEAR(clips[0][i].c_W_m.y(), -mirrored[0][i].c_W_m.y(), 2e-3);
    EXPECT_NEAR(clips[0][i].load[0], mirrored[0][i].load[5], 1e-2);  // Front left, front right.
  }
}

TEST(AddOwnExamples, HaveThePosesThatTheBoardsWerePressedIn) {
  PoseExamples examples;
  const auto added = AddOwnExamples(Take(), Basis(), {}, examples);
  ASSERT_TRUE(added) << added.error().message;
  // From 1.5 s after the five seconds of calibration to the end.
  EXPECT_NEAR(static_cast<double>(examples.poses.size()) / 60,
              Made().motion.duration_s() - (5 - kOffsetS) - 1.5, 1);
  ASSERT_EQ(examples.features.size(), examples.poses.size());
  // The root is over the estimated COM, a little lower than a root's height over the ground.
  for (std::size_t i = 0; i < examples.poses.size(); i += 30) {
    EXPECT_TRUE(examples.features[i].allFinite());
    EXPECT_LT(examples.poses[i].head<2>().norm(), 0.25);
    EXPECT_NEAR(examples.poses[i](2), 0, 0.2);
  }
  EXPECT_EQ(examples.folds.front(), 0);
  EXPECT_GT(examples.folds.back(), 0);
}

}  // namespace
}  // namespace footing::learning
