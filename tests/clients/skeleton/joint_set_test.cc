#include "clients/skeleton/tracking/joint_set.h"

#include <gtest/gtest.h>

namespace footing::skeleton {
namespace {

JointReading At(double x, double y = 0, double z = 0) { return {{x, y, z}, 1}; }

TEST(JointSet, KnowsTheNamesOfEverySender) {
  for (const auto& [name, joint] :
       {std::pair("l_hand", Joint::kLeftHand), std::pair("HandLeft", Joint::kLeftHand),
        std::pair("HAND_LEFT", Joint::kLeftHand), std::pair("LEFT_HAND", Joint::kLeftHand),
        std::pair("right_wrist", Joint::kRightHand), std::pair("AnkleRight", Joint::kRightFoot),
        std::pair("r_foot", Joint::kRightFoot), std::pair("SpineMid", Joint::kTorso),
        std::pair("torso", Joint::kTorso), std::pair("Head", Joint::kHead),
        std::pair("l_elbow", Joint::kLeftElbow), std::pair("left knee", Joint::kLeftKnee)}) {
    JointSet set;
    EXPECT_EQ(set.Add(name, At(1)), JointSet::Taken::kAdded) << name;
    const Skeleton skeleton = set.Finish();
    EXPECT_TRUE(skeleton[joint].present()) << name;
    EXPECT_EQ(skeleton.present(), 1u) << name;
  }
}

TEST(JointSet, LeavesOtherNamesOut) {
  JointSet set;
  for (const char* const name : {"", "l_", "left", "tail", "hand", "left_head", "l_shoulderx",
                                 "a name that is far too long for a joint of any sender"})
    EXPECT_EQ(set.Add(name, At(1)), JointSet::Taken::kUnknown) << name;
  for (const char* const name : {"waist", "l_collar", "HandTipRight", "left_heel", "SpineBase"})
    EXPECT_EQ(set.Add(name, At(1)), JointSet::Taken::kBeside) << name;
  EXPECT_EQ(set.Finish().present(), 0u);
}

TEST(JointSet, TakesTheBetterNameWhateverTheOrder) {
  for (const bool ankle_first : {true, false}) {
    JointSet set;
    set.Add(ankle_first ? "l_ankle" : "l_foot", At(ankle_first ? 1 : 2));
    set.Add(ankle_first ? "l_foot" : "l_ankle", At(ankle_first ? 2 : 1));
    EXPECT_EQ(set.Finish()[Joint::kLeftFoot].p_K_m.x(), 1);
  }
}

TEST(JointSet, FindsARepeatedNameAndKeepsTheFirst) {
  JointSet set;
  set.Add("l_hand", At(1));
  EXPECT_EQ(set.Add("l_hand", At(2)), JointSet::Taken::kRepeated);
  EXPECT_EQ(set.Add("r_hand", At(3)), JointSet::Taken::kAdded);
  EXPECT_EQ(set.Finish()[Joint::kLeftHand].p_K_m.x(), 1);
}

TEST(JointSet, FillsTheTrunkFromItsNeighbours) {
  // MediaPipe has neither neck nor torso nor a middle of the head.
  JointSet set;
  set.Add("left_shoulder", At(-1, 4));
  set.Add("right_shoulder", At(1, 4));
  set.Add("left_hip", At(-1, 0));
  set.Add("right_hip", {{1, 0, 0}, 0.5});
  set.Add("left_ear", At(-1, 6));
  set.Add("right_ear", At(1, 6));
  set.Add("nose", At(0, 6, -1));
  const Skeleton skeleton = set.Finish();
  EXPECT_EQ(skeleton[Joint::kNeck].p_K_m, Eigen::Vector3d(0, 4, 0));
  EXPECT_EQ(skeleton[Joint::kTorso].p_K_m, Eigen::Vector3d(0, 2, 0));
  EXPECT_EQ(skeleton[Joint::kTorso].confidence, 0.5) << "of the least certain neighbour";
  EXPECT_EQ(skeleton[Joint::kHead].p_K_m, Eigen::Vector3d(0, 6, 0));
}

TEST(Joints, MirrorTwiceIsTheSame) {
  for (std::size_t i = 0; i < kJoints; ++i) {
    const auto joint = static_cast<Joint>(i);
    EXPECT_EQ(Mirrored(Mirrored(joint)), joint);
    std::string name(kJointNames[i]);
    if (name.starts_with("l_"))
      name[0] = 'r';
    else if (name.starts_with("r_"))
      name[0] = 'l';
    EXPECT_EQ(kJointNames[Index(Mirrored(joint))], name);
  }
}

}  // namespace
}  // namespace footing::skeleton
