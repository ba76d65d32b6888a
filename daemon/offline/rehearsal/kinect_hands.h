#pragma once

#include <Eigen/Core>
#include <array>
#include <deque>

#include "common/synthetic/random.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::rehearsal {

/// Both hands as a Kinect's skeleton tracker tells them (docs/hands.md): 30 times a second, two of
/// its frames late, with white noise and an offset common to both that changes slowly.
class KinectHands {
 public:
  using Hands = std::array<reconstruction::HandInput, reconstruction::kHands>;

  static constexpr double kPeriodS = 1.0 / 30, kLateS = 2.0 / 30;
  static constexpr double kNoiseM = 0.015, kOffsetM = 0.04, kOffsetChangesS = 5;

  /// `step_s` between frames.
  KinectHands(std::uint64_t seed, double step_s);

  /// What is told when the hands are where `truth` has them; invalid until the first has come.
  Hands Advance(const Hands& truth);

 private:
  struct Sample {
    double arrives_s;
    Hands hands;
  };
  Hands Measure(const Hands& truth);

  synthetic::Random random_;
  double step_s_, now_s_ = 0, next_s_ = 0;
  Eigen::Vector3d offset_m_;
  std::deque<Sample> on_their_way_;
  Hands told_;
};

}  // namespace footing::rehearsal
