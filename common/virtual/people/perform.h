#pragma once

#include <array>
#include <functional>

#include <Eigen/Core>

#include "common/body/body.h"
#include "common/virtual/motion/leg_solver.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/people/script.h"

namespace footing::choreography {

/// The standard person of this height, for whom scripts are made.
Result<body::Body> Performer(double height_m, double mass_kg);

/// A script performed: the motion, and its distance from the script.
struct Performance {
  motion::Motion motion;
  double pressure_error_m = 0;  ///< Root mean square, of the centre of pressure from the script's.
  double foot_error_m = 0;      ///< Most, of a foot from its place.
};

/// The script as a motion of `body` (of Performer), from a T-pose at its first frame on. The feet
/// are where the script says, exactly. The centre of mass goes where the centre of pressure that
/// inverse dynamics find (virtual_sensors) is the script's: c - c_z c'' / (g + c_z'') = p with the
/// moment of the limbs in p, solved as a boundary value problem over the whole motion (Kajita et
/// al. 2003, "Biped walking pattern generation by using preview control of zero-moment point",
/// equation (9)) and repeated with what is left. `progress`, if any, hears the share done.
Performance Perform(const Script& script, const body::Body& body, double rate_hz = 100,
                    const std::function<void(double done)>& progress = nullptr);

/// Pose of the standard person (common/body/body.cc) for values of the channels: its joints by
/// their names.
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
