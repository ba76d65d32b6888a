#include "daemon/simulation/mapping/inputs.h"

#include <algorithm>
#include <cmath>

namespace footing::mapping {
namespace {

using stream::DeviceRole;

const stream::DeviceFeatures* Find(const stream::RigFeatures& rig, DeviceRole role) {
  for (const stream::DeviceFeatures& device : rig.devices) {
    if (device.role == role) return &device;
  }
  return nullptr;
}

LimbFeatures LimbOf(const stream::RigFeatures& rig, DeviceRole role, std::uint32_t mounted_roles) {
  const stream::DeviceFeatures* device = Find(rig, role);
  if (device == nullptr) return {};
  return ToLimb(*device, (mounted_roles & stream::RoleBit(role)) != 0);
}

LimbPair PairOf(const stream::RigFeatures& rig, DeviceRole left_role, DeviceRole right_role,
                std::uint32_t mounted_roles) {
  LimbPair limbs;
  limbs.left = LimbOf(rig, left_role, mounted_roles);
  limbs.right = LimbOf(rig, right_role, mounted_roles);
  const stream::DeviceFeatures* left = Find(rig, left_role);
  const stream::DeviceFeatures* right = Find(rig, right_role);
  if (left == nullptr || right == nullptr) return limbs;
  for (const stream::PairFeatures& pair : rig.pairs) {
    const bool usable = pair.phase_valid && !pair.phase_held && std::isfinite(pair.phase_rad);
    const bool same = pair.left_device == left->device && pair.right_device == right->device;
    const bool swapped = pair.left_device == right->device && pair.right_device == left->device;
    if (!usable || !(same || swapped)) continue;
    limbs.phase_valid = true;
    limbs.phase_rad = same ? pair.phase_rad : -pair.phase_rad;
  }
  return limbs;
}

}  // namespace

LimbFeatures ToLimb(const stream::DeviceFeatures& device, bool mounted) {
  LimbFeatures limb;
  limb.moving = device.moving;
  limb.frequency_valid = device.frequency_valid && std::isfinite(device.frequency_hz);
  limb.amplitude_valid = device.amplitude_valid && std::isfinite(device.amplitude_mps2);
  limb.inclination_valid =
      device.inclination_valid && std::isfinite(device.roll_rad) && std::isfinite(device.pitch_rad);
  limb.swing_valid = device.swing_valid && std::isfinite(device.swing_rad);
  if (limb.frequency_valid) limb.frequency_hz = device.frequency_hz;
  if (limb.amplitude_valid) limb.amplitude_mps2 = device.amplitude_mps2;
  if (limb.inclination_valid) limb.roll_rad = device.roll_rad;
  if (limb.inclination_valid) limb.pitch_rad = device.pitch_rad;
  if (limb.swing_valid) limb.swing_rad = device.swing_rad;
  limb.mounted = mounted;
  limb.present = limb.moving || limb.inclination_valid;
  return limb;
}

void TakeFeatures(const stream::RigFeatures& rig, std::uint32_t mounted_roles, Inputs& inputs) {
  inputs.hands = PairOf(rig, DeviceRole::kLeftHand, DeviceRole::kRightHand, mounted_roles);
  inputs.legs = PairOf(rig, DeviceRole::kLeftLeg, DeviceRole::kRightLeg, mounted_roles);
  inputs.head = LimbOf(rig, DeviceRole::kHead, mounted_roles);
  inputs.trunk = LimbOf(rig, DeviceRole::kTrunk, mounted_roles);
  inputs.simulated = std::any_of(rig.devices.begin(), rig.devices.end(),
                                 [](const auto& device) { return device.simulated; });
}

}  // namespace footing::mapping
