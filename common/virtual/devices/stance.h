#pragma once

#include <Eigen/Core>
#include <array>

#include "common/body/body.h"
#include "common/virtual/motion/leg_solver.h"
#include "common/virtual/devices/body_course.h"

namespace footing::virtual_sensors {

/// Where both feet of a pose are: their ankle joints in W.
using FeetPlaces = std::array<motion::FootPlace, kFeet>;

/// A person who stands where a motion begins, and begins it without moving a foot: nobody slides
/// over a board that carries him.
class Stance {
 public:
  /// The feet stand as in `t_pose`, flat on the ground, but pointing as in `first_q`, the motion's
  /// first frame, and below its ankles, or as near to them as a person stands. The thighs are
  /// turned about themselves as there: a person's legs stay so while he straightens up. The person
  /// faces along x. `body` must outlive it.
  Stance(const body::Body& body, const Eigen::VectorXd& t_pose, const Eigen::VectorXd& first_q);

  /// Moves `q` over the feet and down as far as the legs are too short for their width, and bends
  /// the legs so that they reach them.
  void StandOver(Eigen::VectorXd& q);
  /// Bends the legs of `q` so that the feet are on their way, `share` of it from the stance (0) to
  /// where they are in the first frame of the motion (1); a foot on the ground is there already.
  void KeepFeet(double share, Eigen::VectorXd& q);

 private:
  FeetPlaces Places(const Eigen::VectorXd& q) const;

  const body::Body& body_;
  std::array<motion::LegSolver, kFeet> legs_;
  FeetPlaces stance_, first_;
};

}  // namespace footing::virtual_sensors
