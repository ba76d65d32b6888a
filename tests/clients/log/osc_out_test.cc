#include "clients/log/osc_out.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "clients/skeleton/tracking/dialects.h"
#include "common/base/osc.h"
#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/wire/wire.h"

namespace footing::log_client {
namespace {

using Eigen::Vector3d;

/// A standard person with bent knees and one arm ahead, turned to the left, who walked to x = 2 m.
class OscOutTest : public testing::Test {
 protected:
  OscOutTest() : skeleton_(body::StandardPerson(1.75)), at_(skeleton_) {
    v1::Skeleton& skeleton = *skeletons_.add_skeletons();
    skeleton.set_character(1);
    skeleton.set_name("person");
    for (const body::Joint& joint : skeleton_.joints) {
      v1::Link& link = *skeleton.add_links();
      link.set_name(joint.name);
      link.set_parent(joint.parent);
    }
    const body::Landmarks landmarks = body::FindLandmarks(skeleton_).value();
    q_ = body::TPose(skeleton_, landmarks);
  }

  v1::CharacterFrame Frame() {
    body::ComputeKinematics(skeleton_, q_, at_);
    v1::CharacterFrame frame;
    frame.set_time_s(12.5);
    v1::Character& character = *frame.add_characters();
    character.set_character(1);
    character.set_valid(true);
    character.mutable_body()->set_calibrated(true);
    for (std::size_t joint = 0; joint < at_.p_WJ.size(); ++joint) {
      *character.add_links() =
          wire::ToProto(stream::LinkPose{at_.p_WJ[joint], Eigen::Quaterniond(at_.R_WJ[joint])});
    }
    return frame;
  }

  void Turn(const char* joint, body::Axis axis, double rad) {
    body::SetJointRotation(skeleton_.joint(body::FindJoint(skeleton_, joint)),
                           body::AxisRotation(axis, rad), q_);
  }
  Vector3d PlaceOfJoint(const char* name) const {
    return at_.p_WJ[static_cast<std::size_t>(body::FindJoint(skeleton_, name))];
  }

  /// Every packet fits into a datagram and is one that our strict reader takes.
  std::vector<osc::Packet> Read(std::vector<std::string> packets) {
    std::vector<osc::Packet> read;
    for (std::string& one : packets) {
      const std::string& packet = kept_.emplace_back(std::move(one));
      EXPECT_LE(packet.size(), kMostOscBytes);
      const auto done = osc::Read(osc::AsBytes(packet), read.emplace_back());
      EXPECT_TRUE(done.ok()) << done.error().message;
    }
    return read;
  }

  body::Skeleton skeleton_;
  body::Kinematics at_;
  Eigen::VectorXd q_;
  v1::Skeletons skeletons_;

 private:
  std::deque<std::string> kept_;  ///< Bytes that the packets are views of.
};

/// Seven numbers behind a bone's name.
struct Bone {
  Vector3d p;
  Eigen::Quaterniond q;
};

std::map<std::string, Bone> BonesOf(const std::vector<osc::Packet>& packets) {
  std::map<std::string, Bone> bones;
  for (const osc::Packet& packet : packets) {
    for (const osc::Message& message : packet.messages) {
      if (message.address != "/VMC/Ext/Bone/Pos") continue;
      EXPECT_EQ(message.types, "sfffffff");
      const auto arguments = packet.Of(message);
      const auto number = [&](std::size_t i) { return double{std::get<float>(arguments[i])}; };
      bones[std::string(std::get<std::string_view>(arguments[0]))] = {
          {number(1), number(2), number(3)}, {number(7), number(4), number(5), number(6)}};
    }
  }
  return bones;
}

TEST_F(OscOutTest, InTheTPoseEveryBoneOfVmcIsUnturned) {
  OscEncoder encoder(OscFormat::kVmc);
  encoder.Take(skeletons_);
  const std::vector<std::string> packets = encoder.Encode(Frame());
  const auto bones = BonesOf(Read(packets));
  EXPECT_GE(bones.size(), 20u);
  for (const auto& [name, bone] : bones) {
    EXPECT_NEAR(std::abs(bone.q.w()), 1, 1e-6) << name;
  }
  // Unity: x right, y up, z ahead. The left arm points to -x, the legs to -y.
  EXPECT_LT(bones.at("LeftLowerArm").p.x(), -0.2);
  EXPECT_GT(bones.at("RightLowerArm").p.x(), 0.2);
  EXPECT_LT(bones.at("LeftLowerLeg").p.y(), -0.3);
  EXPECT_GT(bones.at("LeftToes").p.z(), 0.05);
}

TEST_F(OscOutTest, AVmcReaderFindsTheJointsWhereTheyAre) {
  q_.head<3>() << 2, 0.5, 0.9;
  Turn("root", body::Axis::kZ, 0.7);
  Turn("ltibia", body::Axis::kY, 1.0);
  Turn("rtibia", body::Axis::kY, 0.6);
  Turn("lhumerus", body::Axis::kZ, -1.2);
  Turn("lowerback", body::Axis::kY, 0.3);
  OscEncoder encoder(OscFormat::kVmc);
  encoder.Take(skeletons_);
  skeleton::VmcPose pose({});
  std::optional<skeleton::Skeleton> seen;
  const auto packets = Read(encoder.Encode(Frame()));
  for (const osc::Packet& packet : packets) {
    for (const osc::Message& message : packet.messages) {
      const auto step = pose.Take(message.address, packet.Of(message), message.types);
      EXPECT_EQ(step.taken, skeleton::VmcStep::Taken::kTaken) << step.bone;
      if (step.skeleton) seen = step.skeleton;
    }
  }
  ASSERT_TRUE(seen.has_value()) << pose.NoSkeleton();
  // The reader has camera axes: lengths do not depend on them.
  using skeleton::Joint;
  const std::pair<Joint, const char*> joints[] = {
      {Joint::kLeftShoulder, "lhumerus"}, {Joint::kLeftElbow, "lradius"},
      {Joint::kLeftHand, "lhand"},        {Joint::kRightHand, "rhand"},
      {Joint::kLeftHip, "lfemur"},        {Joint::kLeftKnee, "ltibia"},
      {Joint::kLeftFoot, "lfoot"},        {Joint::kRightKnee, "rtibia"},
      {Joint::kRightFoot, "rfoot"},       {Joint::kHead, "upperneck"}};
  for (const auto& [joint, name] : joints) {
    for (const auto& [other, other_name] : joints) {
      const double length_m = ((*seen)[joint].p_K_m - (*seen)[other].p_K_m).norm();
      EXPECT_NEAR(length_m, (PlaceOfJoint(name) - PlaceOfJoint(other_name)).norm(), 1e-5)
          << name << " " << other_name;
    }
  }
}

TEST_F(OscOutTest, BeforeTheTPoseVmcSaysThatItIsAwaited) {
  OscEncoder encoder(OscFormat::kVmc);
  encoder.Take(skeletons_);
  v1::CharacterFrame frame = Frame();
  frame.mutable_characters(0)->mutable_body()->set_calibrated(false);
  frame.mutable_characters(0)->clear_links();
  for (const auto& [progress, state] : {std::pair(0.0, 1), {0.4, 2}}) {
    frame.mutable_characters(0)->mutable_body()->set_calibration_progress(progress);
    const auto packets = Read(encoder.Encode(frame));
    ASSERT_EQ(packets.size(), 1u);
    const osc::Message& message = packets[0].messages.at(0);
    EXPECT_EQ(message.address, "/VMC/Ext/OK");
    EXPECT_EQ(std::get<std::int32_t>(packets[0].Of(message)[1]), state);
    EXPECT_TRUE(BonesOf(packets).empty());
  }
}

TEST_F(OscOutTest, PlainOscHasEveryLinkInWorldAxes) {
  q_.head<3>() << 2, 0.5, 0.9;
  Turn("ltibia", body::Axis::kY, 1.0);
  OscEncoder encoder(OscFormat::kPlain);
  encoder.Take(skeletons_);
  std::size_t links = 0;
  for (const osc::Packet& packet : Read(encoder.Encode(Frame()))) {
    for (const osc::Message& message : packet.messages) {
      if (message.address != "/footing/character/1/link") continue;
      const auto arguments = packet.Of(message);
      const Vector3d p(std::get<float>(arguments[1]), std::get<float>(arguments[2]),
                       std::get<float>(arguments[3]));
      const std::string name(std::get<std::string_view>(arguments[0]));
      EXPECT_LT((p - PlaceOfJoint(name.c_str())).norm(), 1e-6) << name;
      ++links;
    }
  }
  EXPECT_EQ(links, at_.p_WJ.size());
}

TEST_F(OscOutTest, TheBipedIsSentAsAPerson) {
  v1::Skeletons skeletons;
  v1::Skeleton& skeleton = *skeletons.add_skeletons();
  skeleton.set_character(1);
  for (const auto& [name, parent] : std::vector<std::pair<std::string, int>>{
           {"body", -1}, {"left_hip", 0}, {"left_knee", 1}, {"right_hip", 0}, {"right_knee", 3}}) {
    v1::Link& link = *skeleton.add_links();
    link.set_name(name);
    link.set_parent(parent);
    link.mutable_size_m()->set_z(0.8);
  }
  v1::CharacterFrame frame;
  v1::Character& character = *frame.add_characters();
  character.set_character(1);
  const Eigen::Quaterniond none = Eigen::Quaterniond::Identity();
  const Vector3d body(1, 0, 0.95);
  *character.add_links() = wire::ToProto(stream::LinkPose{body, none});
  for (const double side : {0.1, -0.1}) {
    *character.add_links() = wire::ToProto(stream::LinkPose{body + Vector3d(0, side, 0), none});
    *character.add_links() = wire::ToProto(stream::LinkPose{body + Vector3d(0, side, -0.5), none});
  }
  OscEncoder encoder(OscFormat::kVmc);
  encoder.Take(skeletons);
  const auto bones = BonesOf(Read(encoder.Encode(frame)));
  ASSERT_EQ(bones.count("LeftLowerLeg"), 1u);
  // Its legs are shorter than their longest: the knees are bent, alike on both sides.
  const double bent = bones.at("LeftLowerLeg").q.angularDistance(none);
  EXPECT_GT(bent, 0.5);
  EXPECT_NEAR(bones.at("RightLowerLeg").q.angularDistance(none), bent, 1e-5);
  EXPECT_LT((bones.at("Hips").p - Vector3d(0, 0.95, 1)).norm(), 1e-5);
}

TEST(OscSending, AnAddressThatIsNoneIsAUsageError) {
  for (const char* to : {"nowhere", "127.0.0.1:0", "127.0.0.1:99999", "127.0.0.1:x"}) {
    OscOptions options;
    options.from = transport::ParseAddress("unix:/none").value();
    options.to = {to};
    const auto sent = SendOsc(options);
    ASSERT_FALSE(sent.ok());
    EXPECT_EQ(sent.error().kind, ErrorKind::kUsage) << to;
  }
}

}  // namespace
}  // namespace footing::log_client
