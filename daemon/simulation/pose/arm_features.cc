#include "daemon/simulation/pose/arm_features.h"

#include <cmath>

namespace footing::arms {
namespace {

constexpr std::array<double, ArmFeatures::kHistories> kHistoriesS{0.1, 0.3, 1.0};
constexpr double kForceS = 0.04, kForgetS = 0.4;  // Integrals of the acceleration leak.
constexpr double kMostMps2 = 30, kMostRadps = 20;

Eigen::Vector3d Clipped(const Eigen::Vector3d& value, double most) {
  return value.cwiseMax(-most).cwiseMin(most);
}

}  // namespace

void ArmFeatures::Advance(const std::array<HandState, kArms>& hands, double step_s) {
  for (std::size_t arm = 0; arm < kArms; ++arm) {
    const HandState& state = hands[arm];
    Hand& hand = hands_[arm];
    Eigen::Matrix3d turn = state.turn_W;
    Eigen::Vector3d turning = state.angular_velocity_W_radps, force = state.acceleration_W_mps2;
    if (arm == 1) {
      const Eigen::Vector3d mirror(1, -1, 1);
      turn = mirror.asDiagonal() * turn * mirror.asDiagonal();
      turning =
          -MirroredWay(turning);  // A turn is a pseudovector: its mirror image turns the other way.
      force = MirroredWay(force);
    }
    hand.turn = Eigen::Map<const Turn>(turn.data());
    hand.turning = Clipped(turning, kMostRadps);
    hand.force += (1 - std::exp(-step_s / kForceS)) * (Clipped(force, kMostMps2) - hand.force);
    const double kept = std::exp(-step_s / kForgetS);
    hand.speed = kept * (hand.speed + step_s * Clipped(force, kMostMps2));
    hand.way = kept * (hand.way + step_s * hand.speed);
    for (std::size_t k = 0; k < kHistories; ++k) {
      const double share = started_ ? 1 - std::exp(-step_s / kHistoriesS[k]) : 1;
      hand.slow[k] += share * (hand.turn - hand.slow[k]);
    }
  }
  started_ = true;
}

void ArmFeatures::Compute(std::size_t arm, Values& out) const {
  const Hand& own = hands_[arm];
  const Hand& other = hands_[1 - arm];
  Eigen::Index at = 0;
  const auto add = [&](const auto& part) {
    out.segment(at, part.size()) = part;
    at += part.size();
  };
  add(own.turn);
  add(own.turning);
  add(own.force);
  add(own.speed);
  add(own.way);
  for (const Turn& slow : own.slow) add((own.turn - slow).eval());
  add(other.turn);
  add(other.speed);
  for (Eigen::Index i = 0; i < kTurn; ++i) {
    for (Eigen::Index k = 0; k <= i; ++k) out(at++) = own.turn(i) * own.turn(k);
  }
}

}  // namespace footing::arms
