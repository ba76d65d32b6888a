#include "common/body/landmarks.h"

#include <gmock/gmock.h>

#include <array>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

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
  for (const std::string prefix : {"", "Character1_", "mixamorig:", "mixamorig", "mixamorig_"}) {
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

/// The joints of both legs and arms, each on the one before it in its limb.
struct Rig {
  const char* description;
  std::vector<std::string> trunk, left_leg, left_arm, right_leg, right_arm;
  std::array<const char*, 4> wrist_toe_ankle_elbow;  ///< Left joints; "" where there is none.
};

Skeleton Hung(const Rig& rig) {
  std::vector<Joint> joints;
  const auto hang = [&joints](const std::vector<std::string>& names, int on) {
    for (const std::string& name : names) {
      Joint joint;
      joint.name = name;
      joint.parent = on;
      on = static_cast<int>(joints.size());
      joints.push_back(joint);
    }
    return on;
  };
  const int chest = hang(rig.trunk, -1);
  for (const auto* leg : {&rig.left_leg, &rig.right_leg}) hang(*leg, 0);
  for (const auto* arm : {&rig.left_arm, &rig.right_arm}) hang(*arm, chest);
  return MakeSkeleton(std::move(joints));
}

TEST(Landmarks, AreFoundUnderTheNamesOfManyPrograms) {
  const Rig kRigs[] = {{"sides behind the names",
                        {"Hips", "Spine", "Chest", "Neck"},
                        {"UpperLeg_L", "LowerLeg_L", "Foot_L", "Toes_L"},
                        {"Shoulder_L", "UpperArm_L", "LowerArm_L", "Hand_L"},
                        {"UpperLeg_R", "LowerLeg_R", "Foot_R", "Toes_R"},
                        {"Shoulder_R", "UpperArm_R", "LowerArm_R", "Hand_R"},
                        {"Hand_L", "Toes_L", "Foot_L", "LowerArm_L"}},
                       {"a dot before the side",
                        {"hips", "spine", "neck"},
                        {"thigh.L", "shin.L", "foot.L", "toe.L"},
                        {"shoulder.L", "upper_arm.L", "forearm.L", "hand.L"},
                        {"thigh.R", "shin.R", "foot.R", "toe.R"},
                        {"shoulder.R", "upper_arm.R", "forearm.R", "hand.R"},
                        {"hand.L", "toe.L", "foot.L", "forearm.L"}},
                       {"abbreviated shoulders",
                        {"hip", "abdomen", "chest", "neck"},
                        {"lThigh", "lShin", "lFoot"},
                        {"lCollar", "lShldr", "lForeArm", "lHand"},
                        {"rThigh", "rShin", "rFoot"},
                        {"rCollar", "rShldr", "rForeArm", "rHand"},
                        {"lHand", "", "lFoot", "lForeArm"}},
                       {"a foot behind the ankle and a hand behind the wrist",
                        {"Pelvis", "Spine3", "Neck"},
                        {"L_Hip", "L_Knee", "L_Ankle", "L_Foot"},
                        {"L_Collar", "L_Shoulder", "L_Elbow", "L_Wrist", "L_Hand"},
                        {"R_Hip", "R_Knee", "R_Ankle", "R_Foot"},
                        {"R_Collar", "R_Shoulder", "R_Elbow", "R_Wrist", "R_Hand"},
                        {"L_Wrist", "L_Foot", "L_Ankle", "L_Elbow"}},
                       {"names of a game engine",
                        {"pelvis", "spine_03", "neck_01"},
                        {"thigh_l", "calf_l", "foot_l", "ball_l"},
                        {"clavicle_l", "upperarm_l", "lowerarm_l", "hand_l"},
                        {"thigh_r", "calf_r", "foot_r", "ball_r"},
                        {"clavicle_r", "upperarm_r", "lowerarm_r", "hand_r"},
                        {"hand_l", "ball_l", "foot_l", "lowerarm_l"}}};
  for (const Rig& rig : kRigs) {
    const Skeleton skeleton = Hung(rig);
    const auto landmarks = FindLandmarks(skeleton);
    ASSERT_TRUE(landmarks.ok()) << rig.description << ": " << landmarks.error().message;
    const auto name = [&](Landmark landmark) {
      const int joint = (*landmarks)[landmark];
      return joint < 0 ? "" : skeleton.joint(joint).name;
    };
    EXPECT_EQ(name(Landmark::kLeftWrist), rig.wrist_toe_ankle_elbow[0]) << rig.description;
    EXPECT_EQ(name(Landmark::kLeftToe), rig.wrist_toe_ankle_elbow[1]) << rig.description;
    EXPECT_EQ(name(Landmark::kLeftAnkle), rig.wrist_toe_ankle_elbow[2]) << rig.description;
    EXPECT_EQ(name(Landmark::kLeftElbow), rig.wrist_toe_ankle_elbow[3]) << rig.description;
    EXPECT_EQ(name(Landmark::kRightHip), rig.right_leg[0]) << rig.description;
  }
}

TEST(Landmarks, AKneeThatDoesNotHangOnTheHipIsAnError) {
  Rig rig{"",
          {"Hips", "Spine", "Neck"},
          {"LeftLeg", "LeftUpLeg", "LeftFoot"},
          {"LeftArm", "LeftForeArm", "LeftHand"},
          {"RightUpLeg", "RightLeg", "RightFoot"},
          {"RightArm", "RightForeArm", "RightHand"},
          {}};
  const auto landmarks = FindLandmarks(Hung(rig));
  ASSERT_FALSE(landmarks.ok());
  EXPECT_THAT(landmarks.error().message,
              testing::HasSubstr("joint LeftLeg, taken for left_knee, does not hang on joint "
                                 "LeftUpLeg, taken for left_hip"));
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
