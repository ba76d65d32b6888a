#pragma once

#include <Eigen/Core>
#include <array>

#include "daemon/simulation/pose/hand_attitude.h"

namespace footing::arms {

inline constexpr std::size_t kArms = 2;  ///< 0 is the left one.

/// What two hands' states and their past say of an arm, for a linear regression. Everything is in
/// W and is mirrored for the right arm, so that one regression serves both. The body faces along x.
class ArmFeatures {
 public:
  static constexpr int kTurn = 9, kHistories = 3;
  static constexpr int kOtherAt = kTurn + 12 + kTurn * kHistories;  ///< What the other hand says.
  static constexpr int kOther = kTurn + 3;
  static constexpr int kLinear = kOtherAt + kOther;
  static constexpr int kProducts = kTurn * (kTurn + 1) / 2;
  static constexpr int kCount = kLinear + kProducts;
  using Values = Eigen::Matrix<double, kCount, 1>;

  /// The next frame of both hands.
  void Advance(const std::array<HandState, kArms>& hands, double step_s);
  /// Of one arm, in the left arm's frame.
  void Compute(std::size_t arm, Values& out) const;

 private:
  using Turn = Eigen::Matrix<double, kTurn, 1>;
  struct Hand {
    Turn turn = Turn::Zero();
    Eigen::Vector3d turning = Eigen::Vector3d::Zero(), force = Eigen::Vector3d::Zero();
    Eigen::Vector3d speed = Eigen::Vector3d::Zero(), way = Eigen::Vector3d::Zero();
    std::array<Turn, kHistories> slow{Turn::Zero(), Turn::Zero(), Turn::Zero()};
  };
  bool started_ = false;
  std::array<Hand, kArms> hands_;
};

/// A vector of the right arm as the left arm's, and back.
inline Eigen::Vector3d MirroredWay(const Eigen::Vector3d& v) { return {v.x(), -v.y(), v.z()}; }

}  // namespace footing::arms
