#pragma once

#include <array>
#include <cstdint>
#include <deque>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/virtual/devices/kinect_skeleton.h"
#include "daemon/simulation/reconstruction/hand_track.h"
#include "daemon/simulation/reconstruction/inputs.h"

namespace footing::pose_run {

/// Both hands, then the joints by body::IndexOf.
using KinectPoints =
    std::array<virtual_sensors::KinectPoint, virtual_sensors::KinectSkeleton::kPoints>;

/// Hands and joints as a Kinect's skeleton tracker reports them (virtual_sensors::KinectSkeleton)
/// and as they come to the engine: predicted over their delay by reconstruction::HandTrack.
class KinectBody {
 public:
  /// `step_s` between frames.
  KinectBody(const body::Body& body, std::uint64_t seed, double step_s,
             const virtual_sensors::KinectOptions& options);

  /// The inputs get what has come while the joints are `at`: hands, and joints where
  /// `with_joints`; none of them is valid until the first exposure has come.
  void Advance(const body::Kinematics& at, bool with_joints, reconstruction::Inputs& inputs);
  /// The newest exposure, which has not come yet.
  const KinectPoints& exposed() const { return exposed_; }
  bool crouches() const { return skeleton_.crouches(); }

 private:
  struct Sample {
    double exposed_s;
    KinectPoints points;
  };

  virtual_sensors::KinectSkeleton skeleton_;
  double step_s_, now_s_ = 0, next_s_ = 0;
  KinectPoints exposed_{};
  std::deque<Sample> on_their_way_;
  std::array<reconstruction::HandTrack, virtual_sensors::KinectSkeleton::kPoints> tracks_;
};

}  // namespace footing::pose_run
