#pragma once

#include <Eigen/Core>
#include <array>

#include "common/body/body.h"
#include "common/virtual/people/script.h"
#include "common/virtual/motion/leg_solver.h"

namespace footing::choreography {

/// What the channels make of the standard person (standard_person.cc): its joints by their names.
class Posture {
 public:
  /// `body` must outlive it, and be a StandardPerson or a CMU skeleton.
  explicit Posture(const body::Body& body);

  /// Trunk, head and arms into `q`, and the root's orientation; the legs are left alone. Angles
  /// are those nearest to what stands in `q`.
  void PlaceUpperBody(const Values& values, Eigen::Ref<Eigen::VectorXd> q) const;

  /// Where the feet are; 0 is the left one.
  motion::FootPlace FootOf(const Values& values, int foot) const;
  /// Where a standing foot's pressure is, on the ground.
  Eigen::Vector2d RestOf(const Values& values, int foot) const;
  /// Where the script puts the pressure of the whole body, on the ground.
  Eigen::Vector2d PressureOf(const Values& values) const;

  /// The T-pose, its feet at x = 0, flat on z = 0.
  const Eigen::VectorXd& t_pose() const { return t_pose_; }

 private:
  void Turn(int joint, const Eigen::Matrix3d& R_PJ, Eigen::Ref<Eigen::VectorXd> q) const;
  void PlaceArm(const Values& values, bool left, Eigen::Ref<Eigen::VectorXd> q) const;

  const body::Body& body_;
  Eigen::VectorXd t_pose_;
  std::array<int, 3> back_{}, neck_{};
  std::array<motion::FootPlace, 2> standing_;
  std::array<Eigen::Vector2d, 2> rest_;  ///< From the ankle, in the T-pose.
};

}  // namespace footing::choreography
