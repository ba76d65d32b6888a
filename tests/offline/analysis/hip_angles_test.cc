#include "daemon/offline/analysis/pose_metrics.h"

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/body/skeleton.h"

namespace footing::eval {
namespace {

constexpr int kLeft = 0, kRight = 1;

Eigen::Matrix3d Turned(body::Axis axis, double deg) {
  return body::AxisRotation(axis, DegreesToRadians(deg));
}

void ExpectAngles(const HipAngles& angles, double flexion, double abduction, double rotation) {
  EXPECT_NEAR(angles.flexion, flexion, 1e-9);
  EXPECT_NEAR(angles.abduction, abduction, 1e-9);
  EXPECT_NEAR(angles.rotation, rotation, 1e-9);
}

TEST(HipAngles, AreThoseOfASingleTurn) {
  ExpectAngles(HipAnglesDeg(Eigen::Matrix3d::Identity(), kLeft), 0, 0, 0);
  // A thigh that hangs down goes forwards by a turn about the left axis, backwards in its sense.
  ExpectAngles(HipAnglesDeg(Turned(body::Axis::kY, -100), kLeft), 100, 0, 0);
  ExpectAngles(HipAnglesDeg(Turned(body::Axis::kY, 20), kRight), -20, 0, 0);
  // To the left by one about the forward axis: out for the left leg, in for the right one.
  ExpectAngles(HipAnglesDeg(Turned(body::Axis::kX, 30), kLeft), 0, 30, 0);
  ExpectAngles(HipAnglesDeg(Turned(body::Axis::kX, 30), kRight), 0, -30, 0);
  // Toes to the left: out for the left leg, in for the right one.
  ExpectAngles(HipAnglesDeg(Turned(body::Axis::kZ, 25), kLeft), 0, 0, -25);
  ExpectAngles(HipAnglesDeg(Turned(body::Axis::kZ, 25), kRight), 0, 0, 25);
}

TEST(HipAngles, KeepTheRotationOfARaisedThigh) {
  const Eigen::Matrix3d turned = Turned(body::Axis::kZ, 40);
  ExpectAngles(HipAnglesDeg(Turned(body::Axis::kY, -90) * turned, kRight), 90, 0, 40);
  ExpectAngles(HipAnglesDeg(Turned(body::Axis::kX, -60) * turned, kRight), 0, 60, 40);
}

TEST(HipAngles, DifferByAtMostHalfATurn) {
  const HipAngles off = Difference({170, -30, -175}, {-170, 20, 175});
  ExpectAngles(off, 20, 50, 10);
}

TEST(PoseScore, SplitsTheHipsErrorAsGaitAnalysisDoes) {
  body::PersonParameters person;
  person.mass_kg = 70;
  const body::Body body = body::MakeBody(body::StandardPerson(1.75), person).value();
  const Eigen::VectorXd t_pose = body::TPose(body.skeleton, body.landmarks);
  Eigen::VectorXd q = t_pose;
  // The left thigh 30 degrees forwards and the right one 10 inwards, in the axes of W.
  const auto turn = [&](body::Landmark hip, const Eigen::Matrix3d& by) {
    const body::Joint& joint = body.skeleton.joint(body.landmarks[hip]);
    body::SetJointRotation(joint, by * body::JointRotation(joint, t_pose), q);
  };
  turn(body::Landmark::kLeftHip, Turned(body::Axis::kY, -30));
  turn(body::Landmark::kRightHip, Turned(body::Axis::kZ, 10));
  PoseScore score(body);
  score.Add(q, t_pose);
  const LegAngles angles = score.leg_angles_deg();  // Means of both legs.
  EXPECT_NEAR(angles.flexion, 15, 1e-6);
  EXPECT_NEAR(angles.abduction, 0, 1e-6);
  EXPECT_NEAR(angles.rotation, 5, 1e-6);
  EXPECT_NEAR(angles.hip, 20, 1e-6);
  const nlohmann::ordered_json json = score.Json();
  EXPECT_NEAR(json["hip_flexion_deg"].get<double>(), 15, 1e-6);
  EXPECT_NEAR(json["hip_rotation_deg"].get<double>(), 5, 1e-6);
}

}  // namespace
}  // namespace footing::eval
