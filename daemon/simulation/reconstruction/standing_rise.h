#pragma once

#include <Eigen/Core>
#include <array>

#include "daemon/simulation/reconstruction/feet.h"
#include "daemon/simulation/reconstruction/inputs.h"

namespace footing::reconstruction {

/// How high the joints of standing feet are: flat in the T-pose, where the heights are known, and
/// as in other poses once the hands have left their places in it. A plain value.
class StandingRise {
 public:
  void Start() { *this = StandingRise(); }

  /// One frame, the first one in the T-pose: `usual` with this frame's rises and deviations.
  /// `hands`: in W.
  FootSpread Advance(const std::array<HandInput, kHands>& hands, const FootSpread& usual);

 private:
  void FollowHands(const std::array<HandInput, kHands>& hands);

  bool first_ = true;
  bool known_ = false;  ///< Both hands were seen in the first frame.
  std::array<Eigen::Vector3d, kHands> t_pose_W_m_{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  double away_m_ = 0;  ///< Largest distance of the hands from there, in the mean of both.
};

}  // namespace footing::reconstruction
