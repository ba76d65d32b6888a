#include "daemon/simulation/mapping/wrist_features.h"

#include <cmath>

namespace footing::mapping {
namespace {

HandFeatures ToHand(const stream::DeviceFeatures& device) {
  HandFeatures hand;
  hand.present = true;
  hand.moving = device.moving;
  hand.frequency_valid = device.frequency_valid && std::isfinite(device.frequency_hz);
  hand.amplitude_valid = device.amplitude_valid && std::isfinite(device.amplitude_mps2);
  hand.inclination_valid = device.inclination_valid && std::isfinite(device.roll_rad);
  if (hand.frequency_valid) hand.frequency_hz = device.frequency_hz;
  if (hand.amplitude_valid) hand.amplitude_mps2 = device.amplitude_mps2;
  if (hand.inclination_valid) hand.roll_rad = device.roll_rad;
  return hand;
}

const stream::DeviceFeatures* Find(const stream::RigFeatures& rig, stream::DeviceRole role) {
  for (const stream::DeviceFeatures& device : rig.devices) {
    if (device.role == role) return &device;
  }
  return nullptr;
}

}  // namespace

WristFeatures ToWristFeatures(const stream::RigFeatures& rig) {
  const stream::DeviceFeatures* left = Find(rig, stream::DeviceRole::kLeftHand);
  const stream::DeviceFeatures* right = Find(rig, stream::DeviceRole::kRightHand);
  WristFeatures features;
  if (left != nullptr) features.left = ToHand(*left);
  if (right != nullptr) features.right = ToHand(*right);
  features.simulated =
      (left != nullptr && left->simulated) || (right != nullptr && right->simulated);
  if (left == nullptr || right == nullptr) return features;
  for (const stream::PairFeatures& pair : rig.pairs) {
    const bool usable = pair.phase_valid && std::isfinite(pair.phase_rad);
    const bool same = pair.left_device == left->device && pair.right_device == right->device;
    const bool swapped = pair.left_device == right->device && pair.right_device == left->device;
    if (!usable || !(same || swapped)) continue;
    features.phase_valid = true;
    features.phase_rad = same ? pair.phase_rad : -pair.phase_rad;
  }
  return features;
}

}  // namespace footing::mapping
