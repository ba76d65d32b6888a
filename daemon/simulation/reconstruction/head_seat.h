#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>

#include "common/body/kinematics.h"
#include "common/body/points.h"
#include "common/body/skeleton_points.h"
#include "daemon/simulation/reconstruction/inputs.h"

namespace footing::reconstruction {

inline constexpr std::size_t kHeadJoint = body::IndexOf(stream::BodyJoint::kHead);

/// What of the head a tracker shows that shows no skeleton: the sphere of a cap is above the head,
/// by how much nobody measures. It is found in the half second after the T-pose, which the person
/// still holds: boards and hands show that pose better than any other. A value.
class HeadSeat {
 public:
  static constexpr double kSeconds = 0.5;

  /// Whether a head is seen by itself, outside a skeleton, and surely enough to have a seat: one
  /// that a tracker shows to a few centimetres, such as a Kinect's, is the middle of the head.
  static bool IsLone(const JointInputs& joints);

  /// `middle`: the middle of the head on the body.
  void Start(const body::Point& middle);
  /// Whether it is being found: meanwhile the head does not count for the pose.
  bool Seeks() const { return sought_s_ < kSeconds; }
  /// A frame of it: joints in W, and the pose that boards and hands alone show, in W. One that
  /// is not lone adds nothing.
  void See(const JointInputs& joints, const body::Kinematics& at, double step_s);

  /// The point that is seen: that of the seat where it was seen for most of the time, within 35 cm
  /// of the middle; else the middle.
  const body::Point& point() const { return point_; }
  bool found() const { return found_; }

 private:
  body::Point middle_, point_;
  bool found_ = false;
  double sought_s_ = 0, seen_s_ = 0;
  Eigen::Vector3d sum_J_m_ = Eigen::Vector3d::Zero();  ///< Times seconds.
};

}  // namespace footing::reconstruction
