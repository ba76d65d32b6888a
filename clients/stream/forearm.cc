#include "clients/stream/forearm.h"

#include <Eigen/Geometry>

#include "common/body/kinematics.h"
#include "common/motion/edit.h"
#include "common/units/units.h"

namespace footing::stream_client {
namespace {

using body::Landmark;

constexpr double kCutoffHz = 10;
constexpr double kPlaceOnForearm = 2.0 / 3;  // From the elbow; where a strap holds.

/// Orientation of S in the forearm's joint. With hanging arms x is left, y front, z down; z is then
/// along the forearm. A pose in which the arms hang is made from the T-pose.
Eigen::Matrix3d Mounting(const body::Body& body, int side, int elbow,
                         const Eigen::Vector3d& along_J) {
  const Eigen::VectorXd pose = body::TPose(body.skeleton, body.landmarks);
  body::Kinematics at(body.skeleton);
  body::ComputeKinematics(body.skeleton, pose, at);
  const Eigen::Matrix3d& R_WJ = at.R_WJ[static_cast<std::size_t>(elbow)];
  const Eigen::Vector3d along = (R_WJ * along_J).normalized();
  // The arm comes down about the axis to the front.
  const Eigen::Vector3d level(0, side == 0 ? 1 : -1, 0);
  const Eigen::Matrix3d down =
      Eigen::Quaterniond::FromTwoVectors(level, -Eigen::Vector3d::UnitZ()).toRotationMatrix() *
      Eigen::Quaterniond::FromTwoVectors(along, level).toRotationMatrix();
  Eigen::Matrix3d R_WS;
  R_WS.col(0) = Eigen::Vector3d::UnitY();
  R_WS.col(1) = Eigen::Vector3d::UnitX();
  R_WS.col(2) = -Eigen::Vector3d::UnitZ();
  return (down * R_WJ).transpose() * R_WS;
}

Eigen::Vector3d Between(const Eigen::Matrix3Xd& values, const Stage::Instant& at) {
  return (1 - at.share) * values.col(at.frame) + at.share * values.col(at.frame + 1);
}

}  // namespace

Eigen::Vector3d ForearmCourse::ForceAt(const Stage& stage, double t_s) const {
  return Between(specific_force_S_mps2, stage.At(t_s));
}

Eigen::Vector3d ForearmCourse::TurnAt(const Stage& stage, double t_s) const {
  return Between(angular_velocity_S_radps, stage.At(t_s));
}

ForearmCourse FollowForearm(const Stage& stage, int side) {
  const body::Body& body = stage.scene.body;
  const body::Skeleton& skeleton = body.skeleton;
  const auto landmark = [&](Landmark left) {
    return body.landmarks[side == 0 ? left : body::Mirrored(left)];
  };
  const int elbow = landmark(Landmark::kLeftElbow), wrist = landmark(Landmark::kLeftWrist);
  Eigen::Vector3d along_J = Eigen::Vector3d::Zero();  // With the joints between them at rest.
  for (int joint = wrist; joint >= 0 && joint != elbow; joint = skeleton.joint(joint).parent)
    along_J += skeleton.joint(joint).offset_m;
  const Eigen::Vector3d p_J = kPlaceOnForearm * along_J;
  const Eigen::Matrix3d R_JS = Mounting(body, side, elbow, along_J);

  const motion::Motion smooth = motion::Smoothed(stage.scene.motion, kCutoffHz);
  const motion::MotionRates rates = motion::Rates(smooth);
  body::Kinematics at(skeleton);
  body::JointVelocities velocities(skeleton);
  body::JointAccelerations accelerations(skeleton);
  ForearmCourse course;
  course.specific_force_S_mps2.resize(3, smooth.frames());
  course.angular_velocity_S_radps.resize(3, smooth.frames());
  const auto j = static_cast<std::size_t>(elbow);
  for (Eigen::Index i = 0; i < smooth.frames(); ++i) {
    body::ComputeKinematics(skeleton, smooth.q.col(i), at);
    body::ComputeVelocities(skeleton, at, rates.q_dot.col(i), velocities);
    body::ComputeAccelerations(skeleton, at, rates.q_dot.col(i), rates.q_ddot.col(i), velocities,
                               accelerations);
    const Eigen::Vector3d r = at.R_WJ[j] * p_J;
    const Eigen::Vector3d& w = velocities.w_WJ[j];
    const Eigen::Vector3d a =
        accelerations.a_WJ[j] + accelerations.alpha_WJ[j].cross(r) + w.cross(w.cross(r));
    const Eigen::Matrix3d R_SW = (at.R_WJ[j] * R_JS).transpose();
    course.specific_force_S_mps2.col(i) = R_SW * (a + Eigen::Vector3d(0, 0, kStandardGravityMps2));
    course.angular_velocity_S_radps.col(i) = R_SW * w;
  }
  return course;
}

}  // namespace footing::stream_client
