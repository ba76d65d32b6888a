#include "clients/skeleton/tracking/dialects.h"

#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "clients/skeleton/tracking/decoder.h"
#include "tests/clients/skeleton/send.h"

namespace footing::skeleton {
namespace {

TEST(Vmc, PutsBonesIntoTheirChain) {
  // A person who looks along Unity's z: right is x. The left upper arm is turned by 90 degrees
  // about z, so the forearm, 0.3 m along its own -x, hangs down.
  Decoder decoder({});
  std::vector<Decoded> complete;
  std::vector<std::string> messages;
  const auto bone = [&](std::string_view name, float x, float y, float z, float qz = 0,
                        float qw = 1) {
    const osc::Argument arguments[] = {name, x, y, z, 0.f, 0.f, qz, qw};
    messages.push_back(osc::WriteMessage("/VMC/Ext/Bone/Pos", arguments));
  };
  const float half = std::sqrt(0.5f);
  bone("Hips", 0, 1, 0);
  bone("Spine", 0, 0.2f, 0);
  bone("Neck", 0, 0.3f, 0);
  bone("Head", 0, 0.1f, 0.05f);
  bone("LeftUpperArm", -0.2f, 0.25f, 0, half, half);
  bone("LeftLowerArm", -0.3f, 0, 0);
  bone("LeftHand", -0.25f, 0, 0);
  bone("RightUpperArm", 0.2f, 0.25f, 0);
  bone("RightLowerArm", 0.3f, 0, 0);
  bone("RightHand", 0.25f, 0, 0);
  for (const char* const side : {"Left", "Right"}) {
    bone(std::string(side) + "UpperLeg", side[0] == 'L' ? -0.1f : 0.1f, 0, 0);
    bone(std::string(side) + "LowerLeg", 0, -0.45f, 0);
    bone(std::string(side) + "Foot", 0, -0.45f, 0);
  }
  const osc::Argument time[] = {1.f};
  messages.push_back(osc::WriteMessage("/VMC/Ext/T", time));
  Send(decoder, {osc::WriteBundle({}, messages)}, 1, complete);
  ASSERT_EQ(complete.size(), 1u);
  const Skeleton& skeleton = complete[0].skeleton;
  const auto expect = [&](Joint joint, const Eigen::Vector3d& unity) {
    // The camera is in front: what is away from it is behind the person.
    const Eigen::Vector3d p_K(unity.x(), unity.y(), -unity.z());
    EXPECT_LT((skeleton[joint].p_K_m - p_K).norm(), 1e-6) << kJointNames[Index(joint)];
  };
  expect(Joint::kHead, {0, 1.6, 0.05});
  expect(Joint::kLeftShoulder, {-0.2, 1.45, 0});
  expect(Joint::kLeftElbow, {-0.2, 1.15, 0});
  expect(Joint::kLeftHand, {-0.2, 0.9, 0});
  expect(Joint::kRightHand, {0.75, 1.45, 0});
  expect(Joint::kRightFoot, {0.1, 0.1, 0});
  expect(Joint::kTorso, {0, 1.225, 0});  // No Chest was sent: between shoulders and hips.
}

/// The bones of a person in the T-pose; `change` may spoil each message.
class VmcSender {
 public:
  using Change = std::function<void(std::string& name, std::vector<osc::Argument>& arguments)>;

  explicit VmcSender(Change change) : change_(std::move(change)) {}

  std::string Frame() {
    std::vector<std::string> messages;
    const auto bone = [&](std::string name, float x, float y, float z) {
      std::vector<osc::Argument> arguments{std::string_view(), x, y, z, 0.f, 0.f, 0.f, 1.f};
      change_(name, arguments);
      if (name.empty()) return;
      arguments[0] = std::string_view(name);
      messages.push_back(osc::WriteMessage("/VMC/Ext/Bone/Pos", arguments));
    };
    bone("Hips", 0, 1, 0);
    bone("Spine", 0, 0.2f, 0);
    bone("Neck", 0, 0.3f, 0);
    bone("Head", 0, 0.1f, 0);
    for (const char* const side : {"Left", "Right"}) {
      const float x = side[0] == 'L' ? -1 : 1;
      const auto of_side = [side](const char* name) { return std::string(side) + name; };
      bone(of_side("UpperArm"), 0.2f * x, 0.25f, 0);
      bone(of_side("LowerArm"), 0.3f * x, 0, 0);
      bone(of_side("Hand"), 0.25f * x, 0, 0);
      bone(of_side("UpperLeg"), 0.1f * x, 0, 0);
      bone(of_side("LowerLeg"), 0, -0.45f, 0);
      bone(of_side("Foot"), 0, -0.45f, 0);
      bone(of_side("Toes"), 0, -0.05f, 0.13f);
      bone(of_side("IndexProximal"), 0, 0, 0);
    }
    const osc::Argument time[] = {1.f};
    messages.push_back(osc::WriteMessage("/VMC/Ext/T", time));
    return osc::WriteBundle({}, messages);
  }

 private:
  Change change_;
};

struct VmcPlay {
  Decoder decoder{{}};
  std::vector<Decoded> complete;
};

/// Twenty frames.
VmcPlay PlayVmc(const VmcSender::Change& change) {
  VmcPlay play;
  VmcSender sender(change);
  for (int i = 0; i < 20; ++i) Send(play.decoder, {sender.Frame()}, i, play.complete);
  return play;
}

TEST(Vmc, CostsOnlyTheHandWhoseNumbersAreWrong) {
  for (const float wrong : {std::nanf(""), INFINITY}) {
    const VmcPlay play = PlayVmc([wrong](std::string& name, std::vector<osc::Argument>& of) {
      if (name == "LeftHand") of[2] = wrong;
    });
    ASSERT_EQ(play.complete.size(), 20u);
    const Skeleton& skeleton = play.complete[0].skeleton;
    EXPECT_FALSE(skeleton[Joint::kLeftHand].present());
    EXPECT_EQ(skeleton.present(), kJoints - 1);
    EXPECT_EQ(play.decoder.counts().rejected, 20u);
    EXPECT_EQ(play.decoder.NoSkeleton(), "");
  }
  // Bones that hang on a bone go with it.
  const VmcPlay elbow = PlayVmc([](std::string& name, std::vector<osc::Argument>& of) {
    if (name == "RightLowerArm") of[7] = 0.f;
  });
  ASSERT_EQ(elbow.complete.size(), 20u);
  EXPECT_FALSE(elbow.complete[0].skeleton[Joint::kRightElbow].present());
  EXPECT_FALSE(elbow.complete[0].skeleton[Joint::kRightHand].present());
}

TEST(Vmc, ComputesANeckThatIsNotSent) {
  const VmcPlay play = PlayVmc([](std::string& name, std::vector<osc::Argument>&) {
    if (name == "Neck") name.clear();
  });
  ASSERT_EQ(play.complete.size(), 20u);
  const JointReading& neck = play.complete[0].skeleton[Joint::kNeck];
  ASSERT_TRUE(neck.present());
  EXPECT_LT((neck.p_K_m - Eigen::Vector3d(0, 1.45, 0)).norm(), 1e-6) << "between the shoulders";
}

TEST(Vmc, SaysOnceOfEachKindWhyThereIsNoSkeleton) {
  const auto expect = [](const VmcSender::Change& change, std::uint64_t unknown,
                         std::uint64_t rejected, const std::string& why) {
    VmcPlay play = PlayVmc(change);
    EXPECT_TRUE(play.complete.empty()) << why;
    EXPECT_EQ(play.decoder.counts().unknown, unknown) << why;
    EXPECT_EQ(play.decoder.counts().rejected, rejected) << why;
    EXPECT_NE(play.decoder.NoSkeleton().find(why), std::string::npos) << play.decoder.NoSkeleton();
    const auto problems = play.decoder.TakeProblems();
    EXPECT_EQ(problems.size(), unknown + rejected > 0 ? 2u : 1u) << why;
    EXPECT_EQ(problems.back(), play.decoder.NoSkeleton());
    EXPECT_TRUE(play.decoder.TakeProblems().empty());
  };
  // Twenty bones a frame.
  expect(
      [](std::string& name, std::vector<osc::Argument>&) {
        for (char& c : name) c = static_cast<char>(std::tolower(c));
      },
      20 * 20, 0, "bone Hips was never received; the first bones that arrived: 'hips', 'spine'");
  expect(
      [](std::string&, std::vector<osc::Argument>& of) {
        for (std::size_t i = 1; i < of.size(); ++i)
          of[i] = static_cast<double>(std::get<float>(of[i]));
      },
      20 * 20, 0, "bones come as ,sddddddd");
  expect([](std::string&, std::vector<osc::Argument>& of) { of.resize(6); }, 20 * 20, 0,
         "bones come as ,sfffff in place of ,sfffffff");
  expect(
      [](std::string& name, std::vector<osc::Argument>& of) {
        if (name == "Hips") of[7] = 0.f;
      },
      0, 20, "the numbers of bone Hips make no sense");
  expect(
      [](std::string& name, std::vector<osc::Argument>&) {
        if (name == "RightUpperLeg") name.clear();
      },
      0, 0, "bone RightUpperLeg was never received");
  expect(
      [](std::string& name, std::vector<osc::Argument>&) {
        if (name == "Hips") name.clear();
      },
      0, 0, "bone Hips was never received");
}

TEST(Vmc, HasToesAsEvidenceOfTheFront) {
  const VmcPlay play = PlayVmc([](std::string&, std::vector<osc::Argument>&) {});
  ASSERT_EQ(play.complete.size(), 20u);
  ASSERT_TRUE(play.complete[0].skeleton.toes_K_m);
  // Two feet, 13 cm towards the camera.
  EXPECT_LT((*play.complete[0].skeleton.toes_K_m - Eigen::Vector3d(0, -0.1, -0.26)).norm(), 1e-6);
}

}  // namespace
}  // namespace footing::skeleton
