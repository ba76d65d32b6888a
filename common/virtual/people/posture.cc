#include "common/virtual/people/posture.h"

#include <cmath>

#include "common/body/kinematics.h"
#include "common/base/result.h"
#include "common/base/units.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/devices/scene.h"

namespace footing::choreography {
namespace {

using body::Axis;
using body::AxisRotation;
using body::Landmark;

// Shares of a movement of the trunk that the hips make; the rest is the back's.
constexpr double kHipsBow = 0.45, kHipsTwist = 0.35, kHipsBend = 0.2;
constexpr double kToesDownRadPerM = 1.2;  // Of a lifted foot.
// From where a standing foot carries to as far as a leaning body goes, m: well inside the sole.
constexpr double kToFrontM = 0.08, kToHeelM = 0.055;

Eigen::Matrix3d Turned(double forward_rad, double left_rad, double about_rad) {
  return AxisRotation(Axis::kZ, about_rad) * AxisRotation(Axis::kY, forward_rad) *
         AxisRotation(Axis::kX, -left_rad);
}

}  // namespace

Posture::Posture(const body::Body& body)
    : body_(body), t_pose_(body::TPose(body.skeleton, body.landmarks)) {
  const auto joint = [&body](const char* name) {
    const int index = body::FindJoint(body.skeleton, name);
    FOOTING_CHECK(index >= 0);
    return index;
  };
  back_ = {joint("lowerback"), joint("upperback"), joint("thorax")};
  neck_ = {joint("lowerneck"), joint("upperneck"), joint("head")};
  motion::Motion still;
  still.skeleton = body.skeleton;
  still.rate_hz = 100;
  still.q = t_pose_.replicate(1, 2);
  const auto course = virtual_sensors::Follow(body, still);
  body::Kinematics at(body.skeleton);
  body::ComputeKinematics(body.skeleton, t_pose_, at);
  const double share = virtual_sensors::SceneOptions{}.rest_share;
  double middle_x = 0;
  for (std::size_t foot = 0; foot < 2; ++foot) {
    const auto ankle = static_cast<std::size_t>(
        body.landmarks[foot == 0 ? Landmark::kLeftAnkle : Landmark::kRightAnkle]);
    const auto& sole = course.sole_m[foot];
    const Eigen::Vector3d heel = 0.5 * (sole[0].col(0) + sole[1].col(0));
    const Eigen::Vector3d ball = 0.5 * (sole[2].col(0) + sole[3].col(0));
    standing_[foot] = {at.p_WJ[ankle], at.R_WJ[ankle]};
    rest_[foot] = ((1 - share) * heel + share * ball - at.p_WJ[ankle]).head<2>();
    middle_x += 0.25 * (heel.x() + ball.x());
  }
  t_pose_(0) -= middle_x;
  for (motion::FootPlace& place : standing_) place.p_WA.x() -= middle_x;
}

void Posture::Turn(int joint, const Eigen::Matrix3d& R_PJ, Eigen::Ref<Eigen::VectorXd> q) const {
  body::SetJointRotation(body_.skeleton.joint(joint), R_PJ, q);
}

void Posture::PlaceArm(const Values& values, bool left, Eigen::Ref<Eigen::VectorXd> q) const {
  const auto of = [&](Channel l, Channel r) { return At(values, left ? l : r); };
  const double side = left ? 1 : -1;
  const double raise = of(Channel::kLeftRaise, Channel::kRightRaise);
  const double front = of(Channel::kLeftFront, Channel::kRightFront);
  const double roll = of(Channel::kLeftRoll, Channel::kRightRoll);
  const int shoulder = body_.landmarks[left ? Landmark::kLeftShoulder : Landmark::kRightShoulder];
  const int elbow = body_.landmarks[left ? Landmark::kLeftElbow : Landmark::kRightElbow];
  Turn(shoulder,
       AxisRotation(Axis::kZ, -side * front) * AxisRotation(Axis::kX, side * raise) *
           AxisRotation(Axis::kY, -roll),
       q);
  q(body_.skeleton.joint(elbow).first_dof) = of(Channel::kLeftElbow, Channel::kRightElbow);
}

void Posture::PlaceUpperBody(const Values& values, Eigen::Ref<Eigen::VectorXd> q) const {
  const double bow = At(values, Channel::kBow), bend = At(values, Channel::kBend),
               twist = At(values, Channel::kTwist);
  Turn(0, Turned(kHipsBow * bow, kHipsBend * bend, kHipsTwist * twist), q);
  for (const int joint : back_)
    Turn(joint,
         Turned((1 - kHipsBow) * bow / 3, (1 - kHipsBend) * bend / 3, (1 - kHipsTwist) * twist / 3),
         q);
  for (const int joint : neck_)
    Turn(joint, Turned(At(values, Channel::kNod) / 3, 0, At(values, Channel::kLook) / 3), q);
  PlaceArm(values, true, q);
  PlaceArm(values, false, q);
}

motion::FootPlace Posture::FootOf(const Values& values, int foot) const {
  const bool left = foot == 0;
  const auto of = [&](Channel l, Channel r) { return At(values, left ? l : r); };
  motion::FootPlace place = standing_[static_cast<std::size_t>(foot)];
  const double lift = of(Channel::kLeftLift, Channel::kRightLift);
  place.p_WA += Eigen::Vector3d(of(Channel::kLeftStep, Channel::kRightStep),
                                (left ? 1 : -1) * of(Channel::kLeftOut, Channel::kRightOut), lift);
  place.R_WA = AxisRotation(Axis::kY, kToesDownRadPerM * lift) * place.R_WA;
  return place;
}

Eigen::Vector2d Posture::RestOf(const Values& values, int foot) const {
  return FootOf(values, foot).p_WA.head<2>() + rest_[static_cast<std::size_t>(foot)];
}

Eigen::Vector2d Posture::PressureOf(const Values& values) const {
  const double left = 0.5 * (1 + At(values, Channel::kWeight));
  Eigen::Vector2d place = left * RestOf(values, 0) + (1 - left) * RestOf(values, 1);
  const double ahead = At(values, Channel::kAhead);
  place.x() += ahead * (ahead > 0 ? kToFrontM : kToHeelM);
  return place;
}

}  // namespace footing::choreography
