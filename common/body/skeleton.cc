#include "common/body/skeleton.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "common/base/result.h"
#include "common/base/units.h"

namespace footing::body {
namespace {

/// Angle about the axis that brings R nearest to that rotation: the largest trace of R^T R(angle).
double AngleAbout(Axis axis, const Eigen::Matrix3d& R) {
  const int i = (static_cast<int>(axis) + 1) % 3;
  const int j = (static_cast<int>(axis) + 2) % 3;
  return std::atan2(R(j, i) - R(i, j), R(i, i) + R(j, j));
}

struct Triple {
  double first, second, third;
};

/// Angles of R = R(a) R(b) R(c) with a, b, c all different and b in [-pi/2, pi/2].
Triple Decompose(const Eigen::Matrix3d& R, Axis a, Axis b, Axis c, double third_if_locked) {
  const int i = static_cast<int>(a), j = static_cast<int>(b), k = static_cast<int>(c);
  const double sign = (j - i + 3) % 3 == 1 ? 1.0 : -1.0;  // Whether a, b, c is cyclic.
  const double sine = std::clamp(sign * R(i, k), -1.0, 1.0);
  const double cosine = std::hypot(R(i, i), R(i, j));
  const double second = std::atan2(sine, cosine);
  if (cosine > 1e-9) {
    return {std::atan2(-sign * R(j, k), R(k, k)), second, std::atan2(-sign * R(i, j), R(i, i))};
  }
  // Locked: only first and third together are known; the third stays.
  const Eigen::Matrix3d rest =
      R * AxisRotation(c, third_if_locked).transpose() * AxisRotation(b, second).transpose();
  return {AngleAbout(a, rest), second, third_if_locked};
}

}  // namespace

Skeleton MakeSkeleton(std::vector<Joint> joints) {
  Skeleton skeleton;
  skeleton.joints = std::move(joints);
  skeleton.dof = 3;
  for (int i = 0; i < skeleton.size(); ++i) {
    Joint& joint = skeleton.joints[static_cast<std::size_t>(i)];
    FOOTING_CHECK(i == 0 ? joint.parent == -1 : joint.parent >= 0 && joint.parent < i);
    FOOTING_CHECK(joint.rotations.size() <= 3);
    joint.first_dof = skeleton.dof;
    joint.plain_axes = joint.axes.isIdentity(0);
    skeleton.dof += static_cast<int>(joint.rotations.size());
  }
  return skeleton;
}

int FindJoint(const Skeleton& skeleton, std::string_view name) {
  for (int i = 0; i < skeleton.size(); ++i) {
    if (skeleton.joint(i).name == name) return i;
  }
  return -1;
}

bool IsEnd(const Skeleton& skeleton, int joint) {
  if (joint == 0 || !skeleton.joint(joint).rotations.empty()) return false;
  return std::none_of(skeleton.joints.begin(), skeleton.joints.end(),
                      [joint](const Joint& other) { return other.parent == joint; });
}

std::vector<std::string> DofNames(const Skeleton& skeleton) {
  std::vector<std::string> names;
  const auto add = [&names](const std::string& joint, int axis, const char* unit) {
    names.push_back(joint + "." + "xyz"[axis] + unit);
  };
  if (skeleton.size() > 0) {
    for (int axis = 0; axis < 3; ++axis) add(skeleton.joint(0).name, axis, "_m");
  }
  for (const Joint& joint : skeleton.joints) {
    for (const Rotation& rotation : joint.rotations) {
      add(joint.name, static_cast<int>(rotation.axis), "_rad");
    }
  }
  return names;
}

namespace {

Eigen::VectorXd Limits(const Skeleton& skeleton, double of_root, double Rotation::*limit) {
  Eigen::VectorXd limits = Eigen::VectorXd::Constant(skeleton.dof, of_root);
  for (const Joint& joint : skeleton.joints) {
    int dof = joint.first_dof;
    for (const Rotation& rotation : joint.rotations) limits(dof++) = rotation.*limit;
  }
  return limits;
}

}  // namespace

Eigen::VectorXd LowerLimits(const Skeleton& skeleton) {
  return Limits(skeleton, -kUnlimited, &Rotation::lower_rad);
}

Eigen::VectorXd UpperLimits(const Skeleton& skeleton) {
  return Limits(skeleton, kUnlimited, &Rotation::upper_rad);
}

Eigen::Matrix3d AxisRotation(Axis axis, double angle_rad) {
  const double cosine = std::cos(angle_rad), sine = std::sin(angle_rad);
  const int i = (static_cast<int>(axis) + 1) % 3, j = (static_cast<int>(axis) + 2) % 3;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R(i, i) = R(j, j) = cosine;
  R(i, j) = -sine;
  R(j, i) = sine;
  return R;
}

Eigen::Matrix3d JointRotation(const Joint& joint, PoseRef q) {
  Eigen::Matrix3d R = joint.axes;
  int dof = joint.first_dof;
  for (const Rotation& rotation : joint.rotations) R *= AxisRotation(rotation.axis, q(dof++));
  return R * joint.axes.transpose();
}

void SetJointRotation(const Joint& joint, const Eigen::Matrix3d& R_PJ,
                      Eigen::Ref<Eigen::VectorXd> q) {
  Eigen::Matrix3d rest = joint.axes.transpose() * R_PJ * joint.axes;
  const auto& rotations = joint.rotations;
  const int dof = joint.first_dof;
  const bool three = rotations.size() == 3 && rotations[0].axis != rotations[1].axis &&
                     rotations[1].axis != rotations[2].axis &&
                     rotations[0].axis != rotations[2].axis;
  if (!three) {
    for (std::size_t i = 0; i < rotations.size(); ++i) {
      double& angle = q(dof + static_cast<int>(i));
      angle = NearestTurn(AngleAbout(rotations[i].axis, rest), angle);
      rest = AxisRotation(rotations[i].axis, angle).transpose() * rest;
    }
    return;
  }
  const Triple one =
      Decompose(rest, rotations[0].axis, rotations[1].axis, rotations[2].axis, q(dof + 2));
  const Eigen::Vector3d before = q.segment<3>(dof);
  const auto near = [&before](double a, double b, double c) {
    return Eigen::Vector3d(NearestTurn(a, before(0)), NearestTurn(b, before(1)),
                           NearestTurn(c, before(2)));
  };
  const Eigen::Vector3d first = near(one.first, one.second, one.third);
  const Eigen::Vector3d second = near(one.first + kPi, kPi - one.second, one.third + kPi);
  const bool take_first = (first - before).squaredNorm() <= (second - before).squaredNorm();
  q.segment<3>(dof) = take_first ? first : second;
}

}  // namespace footing::body
