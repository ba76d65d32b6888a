#include "daemon/simulation/mapping/inputs.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "common/base/json_text.h"
#include "common/base/units.h"
#include "daemon/simulation/biped/body_state.h"

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
  limb.axial_valid = device.axial_valid && std::isfinite(device.axial_rad);
  if (limb.frequency_valid) limb.frequency_hz = device.frequency_hz;
  if (limb.amplitude_valid) limb.amplitude_mps2 = device.amplitude_mps2;
  if (limb.inclination_valid) limb.roll_rad = device.roll_rad;
  if (limb.inclination_valid) limb.pitch_rad = device.pitch_rad;
  if (limb.swing_valid) limb.swing_rad = device.swing_rad;
  if (limb.axial_valid) limb.axial_rad = device.axial_rad;
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

namespace {

using nlohmann::json;

Result<void> ReadField(const json& root, const TableField& field, const std::string& origin) {
  if (!root.contains(field.key)) return InvalidData(origin + ": " + field.key + " is missing");
  const json& value = root[field.key];
  if (!value.is_number() || value < field.min || value > field.max) {
    return InvalidData(origin + ": " + field.key + " is " + value.dump() + ", allowed is " +
                       std::to_string(field.min) + " to " + std::to_string(field.max));
  }
  const double number = value.get<double>();
  *field.value = field.unit == Unit::kDegrees ? DegreesToRadians(number) : number;
  return {};
}

Result<void> ReadFlag(const json& root, const TableFlag& flag, const std::string& origin) {
  if (!root.contains(flag.key)) return {};
  const json& value = root[flag.key];
  if (!value.is_boolean()) {
    return InvalidData(origin + ": " + flag.key + " is " + value.dump() +
                       ", allowed is true or false");
  }
  *flag.value = value.get<bool>();
  return {};
}

bool IsKnown(const std::string& key, const TableFields& fields,
             const std::vector<TableFlag>& flags) {
  const auto has_key = [&key](const auto& one) { return one.key == key; };
  return key == "version" || key == "how_found" || key == "measured" ||
         std::any_of(fields.begin(), fields.end(), has_key) ||
         std::any_of(flags.begin(), flags.end(), has_key);
}

}  // namespace

double Scaling::operator()(double from) const {
  const double part = std::clamp((from - from_min) / (from_max - from_min), 0.0, 1.0);
  return to_min + part * (to_max - to_min);
}

Result<void> ReadTable(const std::string& text, const std::string& origin,
                       const TableFields& fields, const std::vector<TableFlag>& flags) {
  const auto parsed = text::ParseJson(text, origin);
  if (!parsed) return parsed.error();
  const auto& root = *parsed;
  if (!root.is_object()) return InvalidData(origin + ": not a JSON object");
  if (!root.contains("version") || root["version"] != 1) {
    return InvalidData(origin + ": version must be 1, the only one known");
  }
  for (const auto& item : root.items()) {
    if (!IsKnown(item.key(), fields, flags)) {
      return InvalidData(origin + ": unknown key " + item.key());
    }
  }
  for (const TableField& field : fields) {
    if (auto read = ReadField(root, field, origin); !read) return read.error();
  }
  for (const TableFlag& flag : flags) {
    if (auto read = ReadFlag(root, flag, origin); !read) return read.error();
  }
  return {};
}

Error NotOrdered(const std::string& origin) {
  return InvalidData(origin + ": every _min and _below must lie under its partner");
}

void AddFields(const ScalingKeys& keys, Scaling& scaling, TableFields& fields) {
  fields.push_back({keys.from_min, &scaling.from_min, keys.least_from, keys.most_from});
  fields.push_back({keys.from_max, &scaling.from_max, keys.least_from, keys.most_from});
  fields.push_back({keys.to_min, &scaling.to_min, keys.least_to, keys.most_to});
  fields.push_back({keys.to_max, &scaling.to_max, keys.least_to, keys.most_to});
}

void AddSpeedFields(Scaling& walk_mps_from_hz, Scaling& run_mps_from_hz, TableFields& fields) {
  AddFields({"walk_frequency_min_hz", "walk_frequency_max_hz", "walk_speed_min_mps",
             "walk_speed_max_mps", 0.1, 10, 0, 1.75},
            walk_mps_from_hz, fields);
  AddFields({"run_frequency_min_hz", "run_frequency_max_hz", "run_speed_min_mps",
             "run_speed_max_mps", 0.1, 10, 0, 6},
            run_mps_from_hz, fields);
}

void AddFields(TurnMapping& mapping, bool as_share, TableFields& fields) {
  if (as_share) {
    fields.push_back({"turn_above", &mapping.turn_above, 0.01, 1});
    fields.push_back({"straight_below", &mapping.straight_below, 0, 1});
  } else {
    fields.push_back({"turn_above_deg", &mapping.turn_above, 1, 90, Unit::kDegrees});
    fields.push_back({"straight_below_deg", &mapping.straight_below, 0, 90, Unit::kDegrees});
  }
  fields.push_back({"turn_per_step_deg", &mapping.turn_per_step_rad, 0, biped::kTurnPerStepMaxDeg,
                    Unit::kDegrees});
}

void Turn::Rest() {
  side_ = 0;
  valid_ = false;
  share_ = 0;
}

double Turn::Advance(double time_s, std::optional<double> right) {
  valid_ = right.has_value();
  if (right) {
    known_s_ = time_s;
    share_ = std::clamp(*right / mapping_.turn_above, -3.0, 3.0);
    const bool inclined = *right * side_ > 0;
    const double border = inclined ? mapping_.straight_below : mapping_.turn_above;
    side_ = std::fabs(*right) <= border ? 0 : *right > 0 ? 1 : -1;
  } else if (time_s - known_s_ > kHoldS) {
    Rest();
  }
  return -side_ * mapping_.turn_per_step_rad;
}

}  // namespace footing::mapping
