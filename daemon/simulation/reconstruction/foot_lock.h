#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace footing::reconstruction {

struct FootLockConfig {
  double ease_s = 0.1;     ///< From where the foot was shown to where it landed (section 4.4).
  double free_s = 0.15;    ///< The estimate is followed for this time after a landing,
  double band_m = 0.018;   ///< then it is followed when it is further away than this,
  double follow_s = 0.05;  ///< with this time constant.
};

/// Where on the ground a foot is shown. Standing feet do not slide, but their estimated place
/// wanders while it takes in the centre of pressure: what is shown is held while the estimate stays
/// near. Heights are those that are estimated.
/// A plain value.
class FootLock {
 public:
  static constexpr std::size_t kPoints = 2;
  using Places = std::array<Eigen::Vector3d, kPoints>;  ///< Of ankle and ball, W, m.

  explicit FootLock(const FootLockConfig& config = {}) : config_(config) {}

  /// `estimated`: where the points are estimated to be; `shown`: where they were shown in the frame
  /// before. Returns where to show them; off the ground that is where they are estimated to be.
  Places Advance(bool contact, const Places& estimated, const Places& shown, double step_s);

 private:
  FootLockConfig config_;
  bool held_ = false;
  double since_s_ = 0;                                               ///< The landing.
  Eigen::Vector2d place_m_ = Eigen::Vector2d::Zero();                ///< Of the ankle.
  Places from_m_{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};  ///< Beside the place.
};

}  // namespace footing::reconstruction
