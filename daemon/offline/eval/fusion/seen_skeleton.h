#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/virtual/sensors/kinect_errors.h"
#include "daemon/simulation/pose/targets.h"

namespace footing::eval {

/// A joint as a camera's skeleton tracker reports it.
struct SeenJoint {
  body::Landmark landmark = body::Landmark::kHips;
  int joint = 0;
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d sd_m = Eigen::Vector3d::Ones();
};

/// Head, neck, shoulders, elbows, wrists, hips and knees, 30 times a second, with the errors of a
/// Kinect (virtual_sensors::KinectErrors); of joints that it infers three times those.
class SeenSkeleton {
 public:
  SeenSkeleton(const body::Body& body, std::uint64_t seed, double step_s);

  /// One step: where the joints are reported to be. A value of the last exposure stays.
  const std::vector<SeenJoint>& Advance(const body::Kinematics& truth, bool legs_hidden);

 private:
  virtual_sensors::KinectErrors errors_;
  double step_s_, now_s_ = 0, next_s_ = 0;
  std::vector<SeenJoint> joints_;
};

/// The joints as terms of the solver.
void AddSkeletonTargets(const std::vector<SeenJoint>& joints, pose::PoseTargets& targets);

}  // namespace footing::eval
