#include "common/virtual/devices/body_course.h"

#include <algorithm>
#include <vector>

#include "common/body/kinematics.h"
#include "common/body/momentum.h"
#include "common/base/quantile.h"
#include "common/virtual/motion/edit.h"
#include "common/virtual/devices/derivative.h"

namespace footing::virtual_sensors {
namespace {

using body::Landmark;

constexpr double kHeelBehindM = 0.045;  // Of the ankle.
constexpr double kHeelHalfWidthM = 0.03;
constexpr double kBallHalfWidthM = 0.04;
// Standing height of a corner: lower in few frames only.
constexpr double kLowShare = 0.03;

struct FootJoints {
  int ankle, toe;
};

FootJoints JointsOf(const body::Body& body, int foot) {
  const auto at = [&](Landmark left, Landmark right) {
    return body.landmarks[foot == 0 ? left : right];
  };
  const int ankle = at(Landmark::kLeftAnkle, Landmark::kRightAnkle);
  int toe = at(Landmark::kLeftToeEnd, Landmark::kRightToeEnd);
  if (toe < 0) toe = at(Landmark::kLeftToe, Landmark::kRightToe);
  return {ankle, toe < 0 ? ankle : toe};
}

void PlaceSole(const body::Kinematics& at, const FootJoints& joints, Eigen::Index frame,
               std::array<Eigen::Matrix3Xd, kFootPoints>& sole) {
  const Eigen::Vector3d ankle = at.p_WJ[static_cast<std::size_t>(joints.ankle)];
  const Eigen::Vector3d toe = at.p_WJ[static_cast<std::size_t>(joints.toe)];
  Eigen::Vector3d ahead = toe - ankle;
  ahead.z() = 0;
  ahead = ahead.norm() > 1e-6 ? Eigen::Vector3d(ahead.normalized()) : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d side(-ahead.y(), ahead.x(), 0);
  const Eigen::Vector3d heel = ankle - kHeelBehindM * ahead;
  sole[0].col(frame) = heel + kHeelHalfWidthM * side;
  sole[1].col(frame) = heel - kHeelHalfWidthM * side;
  sole[2].col(frame) = toe + kBallHalfWidthM * side;
  sole[3].col(frame) = toe - kBallHalfWidthM * side;
}

}  // namespace

BodyCourse Follow(const body::Body& body, const motion::Motion& motion, double cutoff_hz) {
  BodyCourse course;
  course.rate_hz = motion.rate_hz;
  course.mass_kg = body.mass_kg;
  const Eigen::Index n = motion.frames();
  course.com_m.resize(3, n);
  course.angular_momentum.resize(3, n);
  for (auto& foot : course.sole_m)
    for (auto& point : foot) point.resize(3, n);
  if (n == 0) return course;

  const Eigen::MatrixXd q = motion::Smoothed(motion, cutoff_hz).q;
  const Eigen::MatrixXd q_dot = Derivative(q, motion.rate_hz);
  body::Kinematics at(body.skeleton);
  body::JointVelocities velocities(body.skeleton);
  const std::array<FootJoints, kFeet> feet{JointsOf(body, 0), JointsOf(body, 1)};
  for (Eigen::Index i = 0; i < n; ++i) {
    body::ComputeKinematics(body.skeleton, q.col(i), at);
    body::ComputeVelocities(body.skeleton, at, q_dot.col(i), velocities);
    const body::Momentum momentum = body::ComputeMomentum(body, at, velocities);
    course.com_m.col(i) = momentum.p_WC;
    course.angular_momentum.col(i) = momentum.angular_W;
    for (std::size_t f = 0; f < kFeet; ++f) PlaceSole(at, feet[f], i, course.sole_m[f]);
  }
  for (auto& foot : course.sole_m) {
    for (auto& point : foot) {
      const std::vector<double> heights(point.row(2).begin(), point.row(2).end());
      point.row(2).array() -= text::Quantile(heights, kLowShare);
    }
  }
  return course;
}

}  // namespace footing::virtual_sensors
