#include "common/virtual/motion/bvh.h"

#include <gmock/gmock.h>

#include "common/base/units.h"
#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/virtual/devices/noise.h"

namespace footing::motion {
namespace {

using testing::HasSubstr;

constexpr const char* kArm = R"(HIERARCHY
ROOT Hips
{
  OFFSET 1 2 3
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Arm
  {
    OFFSET 10 0 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 30 0 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.0083333
0 90 0 0 0 0 0 0 0
5 91 -7 0 0 90 90 0 0
)";

std::string BvhWith(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

TEST(Bvh, PlacesJointsInTheWorld) {
  const auto motion = ParseBvh(kArm, "arm.bvh");
  ASSERT_TRUE(motion.ok()) << motion.error().message;
  EXPECT_EQ(motion->rate_hz, 120);
  EXPECT_EQ(motion->frames(), 2);
  ASSERT_EQ(motion->skeleton.size(), 3);
  EXPECT_EQ(motion->skeleton.joint(2).name, "Arm_end");
  body::Kinematics at(motion->skeleton);
  ComputeKinematics(motion->skeleton, motion->q.col(0), at);
  // x of the file is left: y of W; its y is up.
  EXPECT_TRUE(at.p_WJ[2].isApprox(Eigen::Vector3d(0, 0.4, 0.9), 1e-12));
  ComputeKinematics(motion->skeleton, motion->q.col(1), at);
  // The root turned left by 90 degrees about up: the arm's base points from x to -z of the file,
  // that is backwards in W; then the arm itself turned by 90 degrees about its z, so it points up.
  EXPECT_TRUE(at.p_WJ[1].isApprox(Eigen::Vector3d(-0.07 - 0.1, 0.05, 0.91), 1e-12));
  EXPECT_TRUE(at.p_WJ[2].isApprox(Eigen::Vector3d(-0.17, 0.05, 0.91 + 0.3), 1e-12));
}

TEST(Bvh, OurOwnOutputIsReadAndWrittenAgainByteForByte) {
  Motion motion{body::StandardPerson(1.75), 60, 0, {}};
  noise::Random random(3);
  motion.q.resize(motion.skeleton.dof, 20);
  for (Eigen::Index i = 0; i < motion.q.size(); ++i) motion.q(i) = random.Uniform(-1.5, 1.5);
  const std::string once = WriteBvh(motion);
  const auto again = ParseBvh(once, "once");
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ(WriteBvh(*again), once);
  // And the joints are where they were, to the decimals written.
  body::Kinematics here(motion.skeleton), there(again->skeleton);
  for (Eigen::Index frame = 0; frame < 20; ++frame) {
    ComputeKinematics(motion.skeleton, motion.q.col(frame), here);
    ComputeKinematics(again->skeleton, again->q.col(frame), there);
    for (int i = 0; i < motion.skeleton.size(); ++i) {
      const int other = body::FindJoint(again->skeleton, motion.skeleton.joint(i).name);
      ASSERT_GE(other, 0) << motion.skeleton.joint(i).name;
      EXPECT_LT(
          (here.p_WJ[static_cast<std::size_t>(i)] - there.p_WJ[static_cast<std::size_t>(other)])
              .norm(),
          1e-6);
    }
  }
}

TEST(Bvh, KeepsTheOrderOfRotationsItReads) {
  const std::string once = WriteBvh(ParseBvh(kArm, "arm.bvh").value());
  EXPECT_THAT(once, HasSubstr("CHANNELS 3 Zrotation Xrotation Yrotation"));
  EXPECT_THAT(once, HasSubstr("OFFSET 1.000000 2.000000 3.000000"));
  EXPECT_EQ(WriteBvh(ParseBvh(once, "once").value()), once);
}

TEST(Bvh, PositionChannelsOfAJointMayOnlyRepeatWhereItIs) {
  const std::string six =
      BvhWith(kArm, "CHANNELS 3 Zrotation", "CHANNELS 6 Xposition Yposition Zposition Zrotation");
  const std::string still = BvhWith(BvhWith(six, "0 90 0 0 0 0 0 0 0", "0 90 0 0 0 0 12 0 0 0 0 0"),
                                    "5 91 -7 0 0 90 90 0 0", "5 91 -7 0 0 90 12 0 0 90 0 0");
  const auto motion = ParseBvh(still, "six.bvh");
  ASSERT_TRUE(motion.ok()) << motion.error().message;
  EXPECT_TRUE(motion->skeleton.joint(1).offset_m.isApprox(Eigen::Vector3d(0, 0.12, 0)));
  const auto moving = ParseBvh(BvhWith(still, "90 12 0 0 90 0 0", "90 13 0 0 90 0 0"), "six.bvh");
  EXPECT_THAT(moving.error().message, HasSubstr("joint Arm moves on its parent"));
}

/// Hips that move on a joint on the floor, and two legs.
constexpr const char* kOnTheFloor = R"(HIERARCHY
ROOT Floor
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Hips
  {
    OFFSET 0 90 0
    CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
    JOINT LeftUpLeg
    {
      OFFSET 10 0 0
      CHANNELS 3 Zrotation Xrotation Yrotation
    }
    JOINT RightUpLeg
    {
      OFFSET -10 0 0
      CHANNELS 3 Zrotation Xrotation Yrotation
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.01
0 0 0 0 0 0 0 90 0 0 0 0 0 0 0 0 0 0
100 0 0 0 0 90 20 80 0 0 30 0 0 0 40 0 0 0
)";

TEST(Bvh, HipsThatMoveOnAJointOnTheFloorAreTheRoot) {
  const auto motion = ParseBvh(kOnTheFloor, "floor.bvh");
  ASSERT_TRUE(motion.ok()) << motion.error().message;
  ASSERT_EQ(motion->skeleton.size(), 3);
  EXPECT_EQ(motion->skeleton.joint(0).name, "Hips");
  EXPECT_EQ(motion->skeleton.dof, 12);
  body::Kinematics at(motion->skeleton);
  ComputeKinematics(motion->skeleton, motion->q.col(0), at);
  EXPECT_TRUE(at.p_WJ[1].isApprox(Eigen::Vector3d(0, 0.1, 0.9), 1e-12));
  ComputeKinematics(motion->skeleton, motion->q.col(1), at);
  // 1 m to the left, then by a quarter turn to the left: 20 cm aside become 20 cm back.
  EXPECT_TRUE(at.p_WJ[0].isApprox(Eigen::Vector3d(-0.2, 1, 0.8), 1e-12));
  EXPECT_TRUE(at.p_WJ[1].isApprox(Eigen::Vector3d(-0.3, 1, 0.8), 1e-12));
  EXPECT_NEAR(motion->q(8, 1), DegreesToRadians(40), 1e-12);
  // Hips that stay where they are keep their place in the tree.
  const auto still =
      ParseBvh(BvhWith(kOnTheFloor, "0 90 20 80 0 0 30", "0 90 0 90 0 0 30"), "still.bvh");
  ASSERT_TRUE(still.ok()) << still.error().message;
  EXPECT_EQ(still->skeleton.joint(0).name, "Floor");
}

TEST(Bvh, ErrorsSayFileLineAndWhatWasExpected) {
  const struct {
    std::string text, message;
  } kRows[] = {
      {"", "expected HIERARCHY, found the end of the file"},
      {BvhWith(kArm, "ROOT", "BOOT"), "arm.bvh, line 2: expected ROOT"},
      {BvhWith(kArm, "OFFSET 10 0 0", "OFFSET 10 0"), "line 9: expected a number of OFFSET"},
      {BvhWith(kArm, "OFFSET 10 0 0", "OFFSET 1e300 0 0"), "line 8: expected a number of OFFSET"},
      {BvhWith(kArm, "3 Zrotation", "3 Wrotation"), "expected a channel such as"},
      {BvhWith(kArm, "3 Zrotation Xrotation", "3 Zrotation Zrotation"), "stands twice"},
      {BvhWith(kArm, "6 Xposition Yposition", "5 Yposition"), "the root needs"},
      {BvhWith(kArm, "Frames: 2", "Frames: 3"), "announced"},
      {BvhWith(kArm, "Frames: 2", "Frames: 1"), "more frames than the 1 announced"},
      {BvhWith(kArm, "Frames: 2", "Frames: 4000000000"), "too short"},
      {BvhWith(kArm, "0.0083333", "0"), "expected a frame time"},
      {BvhWith(kArm, "5 91 -7 0 0 90 90 0 0", "5 91 -7 0 0 90 90 0"),
       "line 20: frame 2: expected number 9 of 9 within +-1e9, found the end of the line"},
      {BvhWith(kArm, "5 91 -7", "5 91 nan"), "found 'nan'"},
      {BvhWith(kArm, "90 90 0 0", "90 90 0 0 1"), "more than the 9"},
  };
  for (const auto& row : kRows) {
    const auto motion = ParseBvh(row.text, "arm.bvh");
    ASSERT_FALSE(motion.ok()) << row.message;
    EXPECT_THAT(motion.error().message, HasSubstr(row.message));
    EXPECT_EQ(motion.error().kind, ErrorKind::kInvalidData);
  }
}

TEST(Bvh, EveryCutOfAFileIsRefusedOrRead) {
  const std::string text = kArm;
  for (std::size_t length = 0; length < text.size(); ++length) {
    const auto motion = ParseBvh(std::string_view(text).substr(0, length), "cut");
    if (motion.ok()) {
      EXPECT_EQ(motion->frames(), 2);
    }
  }
}

TEST(Bvh, DeepTreesAreRefused) {
  std::string text = "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 0\n";
  for (int i = 0; i < 100'000; ++i) text += "JOINT b\n{\nOFFSET 0 0 0\nCHANNELS 0\n";
  EXPECT_THAT(ParseBvh(text, "deep").error().message, HasSubstr("levels"));
}

}  // namespace
}  // namespace footing::motion
