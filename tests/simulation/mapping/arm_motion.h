#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "common/base/units.h"
#include "common/virtual/devices/accelerometer.h"
#include "daemon/offline/analysis/features_chain.h"
#include "daemon/simulation/mapping/inputs.h"

namespace footing::mapping {

/// Two arms that swing about their shoulders in planes fore and aft, with a controller in each
/// hand. World frame W: x forward, y left, z up.
struct ArmSwing {
  double frequency_hz = 1;
  double phase_rad = kPi;    ///< Right minus left.
  double swing_rad = 0.45;   ///< Half the shoulder's way.
  double elbow_rad = 0;      ///< 0 straight, pi/2 bent.
  double grip_left_rad = 0;  ///< Rotation of the controller about the forearm, left side up.
  double grip_right_rad = 0;
  double twist_rad = 0;  ///< The same of both arms, by intention: to the right.
};

/// Specific force in the controller at `t_s`, m/s². Its front points along the forearm to the
/// fingers; of a `mounted` one that is down in M.
inline Eigen::Vector3d ArmForce(const ArmSwing& arm, bool left, bool mounted, double t_s) {
  const auto angle = [&](double t) {
    return arm.swing_rad * std::sin(2 * kPi * arm.frequency_hz * t + (left ? 0 : arm.phase_rad));
  };
  const auto direction = [](double flexion_rad) {
    return Eigen::Vector3d(std::sin(flexion_rad), 0, -std::cos(flexion_rad));
  };
  const auto hand = [&](double t) -> Eigen::Vector3d {
    return 0.30 * direction(angle(t)) + 0.35 * direction(angle(t) + arm.elbow_rad);
  };
  constexpr double kStepS = 1e-3;
  const Eigen::Vector3d acceleration =
      (hand(t_s + kStepS) - 2 * hand(t_s) + hand(t_s - kStepS)) / (kStepS * kStepS);
  const Eigen::Vector3d force_W = acceleration + Eigen::Vector3d(0, 0, kStandardGravityMps2);
  const Eigen::Vector3d along = direction(angle(t_s) + arm.elbow_rad);
  const double rotation_rad = (left ? arm.grip_left_rad : arm.grip_right_rad) + arm.twist_rad;
  const Eigen::Vector3d side = Eigen::AngleAxisd(rotation_rad, along) * Eigen::Vector3d::UnitY();
  const Eigen::Vector3d third = side.cross(along);  // Third of the axes left, along, third.
  if (mounted) return {force_W.dot(side), -force_W.dot(third), force_W.dot(along)};
  return {force_W.dot(side), force_W.dot(along), force_W.dot(third)};
}

/// Both arms' sensors and footingd's chain from samples to features.
class Arms {
 public:
  explicit Arms(bool mounted) : mounted_(mounted), chain_(true) {}

  /// The inputs 10 ms later.
  Inputs Advance(const ArmSwing& arm) {
    const double t_s = 0.01 * static_cast<double>(++readings_);
    const std::int64_t now_ns = 10'000'000 * readings_;
    for (const bool left : {true, false}) {
      const auto reading = wrists::Read(sensor_, ArmForce(arm, left, mounted_, t_s), random_);
      chain_.Add(left ? eval::kLeftDevice : eval::kRightDevice, now_ns, reading.specific_force_mps2,
                 reading.clipped_axes);
    }
    const std::uint32_t mounted_roles = mounted_ ? ~0u : 0;
    TakeFeatures(chain_.Compute(now_ns), mounted_roles, inputs_);
    return inputs_;
  }
  double time_s() const { return 0.01 * static_cast<double>(readings_); }

 private:
  bool mounted_;
  eval::Chain chain_;
  noise::Random random_{7};
  wrists::SensorModel sensor_;
  std::int64_t readings_ = 0;
  Inputs inputs_;
};

}  // namespace footing::mapping
