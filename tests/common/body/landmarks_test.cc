#include "common/body/landmarks.h"

#include <gmock/gmock.h>

#include <sstream>

#include "common/body/body.h"

namespace footing::body {
namespace {

Skeleton Named(const std::string& names) {
  std::istringstream list(names);
  std::vector<Joint> joints;
  for (std::string name; list >> name;) {
    Joint joint;
    joint.name = name;
    joint.parent = static_cast<int>(joints.size()) - 1;
    joints.push_back(joint);
  }
  return MakeSkeleton(std::move(joints));
}

TEST(Landmarks, AreFoundInTheStandardPerson) {
  const Skeleton skeleton = StandardPerson(1.7);
  const Landmarks landmarks = FindLandmarks(skeleton).value();
  for (int i = 0; i < kLandmarkCount; ++i) {
    EXPECT_GE(landmarks[static_cast<Landmark>(i)], 0) << LandmarkName(static_cast<Landmark>(i));
  }
  EXPECT_EQ(skeleton.joint(landmarks[Landmark::kRightKnee]).name, "rtibia");
  EXPECT_EQ(skeleton.joint(landmarks[Landmark::kLeftWrist]).name, "lhand");
}

TEST(Landmarks, AreFoundUnderMotionBuildersNamesWithAnyPrefix) {
  for (const std::string prefix : {"", "Character1_", "mixamorig:"}) {
    std::string names;
    for (const char* name :
         {"Hips", "LeftUpLeg", "LeftLeg", "LeftFoot", "RightUpLeg", "RightLeg", "RightFoot",
          "Spine", "Neck", "Head", "LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand",
          "RightShoulder", "RightArm", "RightForeArm", "RightHand"}) {
      names += prefix + name + " ";
    }
    const Skeleton skeleton = Named(names);
    const auto landmarks = FindLandmarks(skeleton);
    ASSERT_TRUE(landmarks.ok()) << landmarks.error().message;
    EXPECT_EQ(skeleton.joint((*landmarks)[Landmark::kLeftShoulder]).name, prefix + "LeftArm");
    EXPECT_EQ(skeleton.joint((*landmarks)[Landmark::kRightClavicle]).name,
              prefix + "RightShoulder");
    EXPECT_EQ((*landmarks)[Landmark::kLeftToe], -1);
  }
}

TEST(Landmarks, AMissingOneIsNamedWithTheJointsThereAre) {
  const auto landmarks = FindLandmarks(Named("root lfemur ltibia"));
  ASSERT_FALSE(landmarks.ok());
  EXPECT_THAT(landmarks.error().message,
              testing::AllOf(testing::HasSubstr("neck"), testing::HasSubstr("lfemur")));
}

TEST(Landmarks, MirrorsSwapTheSides) {
  EXPECT_EQ(Mirrored(Landmark::kLeftToe), Landmark::kRightToe);
  EXPECT_EQ(Mirrored(Landmark::kRightClavicle), Landmark::kLeftClavicle);
  EXPECT_EQ(Mirrored(Landmark::kVertex), Landmark::kVertex);
}

}  // namespace
}  // namespace footing::body
