#pragma once

#include <array>
#include <deque>

#include "common/virtual/sensors/kinect_errors.h"
#include "daemon/simulation/reconstruction/hand_track.h"

namespace footing::pose_run {

/// Both hands as a Kinect's skeleton tracker reports them (virtual_sensors::KinectErrors) and as
/// they come to the engine: predicted over their delay by reconstruction::HandTrack.
class KinectHands {
 public:
  using Hands = std::array<reconstruction::HandInput, reconstruction::kHands>;

  /// `step_s` between frames.
  KinectHands(std::uint64_t seed, double step_s);

  /// The report when the hands are where `truth` has them; invalid until the first has come.
  Hands Advance(const Hands& truth);

 private:
  struct Sample {
    double exposed_s;
    std::array<Eigen::Vector3d, reconstruction::kHands> p_W_m;
  };

  virtual_sensors::KinectErrors errors_;
  double step_s_, now_s_ = 0, next_s_ = 0;
  std::deque<Sample> on_their_way_;
  std::array<reconstruction::HandTrack, reconstruction::kHands> tracks_;
};

}  // namespace footing::pose_run
