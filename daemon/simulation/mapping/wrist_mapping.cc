#include "daemon/simulation/mapping/wrist_mapping.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "common/units/units.h"
#include "daemon/simulation/biped/limits.h"

namespace footing::mapping {
namespace {

using nlohmann::json;

enum class Unit { kSi, kDegrees };

struct Field {
  const char* key;
  double* value;
  double min, max;
  Unit unit = Unit::kSi;
};

auto Fields(WristMapping& m) {
  return std::array{
      Field{"walk_frequency_min_hz", &m.walk_mps_from_hz.from_min, 0.1, 10},
      Field{"walk_frequency_max_hz", &m.walk_mps_from_hz.from_max, 0.1, 10},
      Field{"walk_speed_min_mps", &m.walk_mps_from_hz.to_min, 0, 1.75},
      Field{"walk_speed_max_mps", &m.walk_mps_from_hz.to_max, 0, 1.75},
      Field{"run_frequency_min_hz", &m.run_mps_from_hz.from_min, 0.1, 10},
      Field{"run_frequency_max_hz", &m.run_mps_from_hz.from_max, 0.1, 10},
      Field{"run_speed_min_mps", &m.run_mps_from_hz.to_min, 0, 6},
      Field{"run_speed_max_mps", &m.run_mps_from_hz.to_max, 0, 6},
      Field{"walk_run_border_hz", &m.walk_run_border_hz, 0.1, 10},
      Field{"walk_run_hysteresis_hz", &m.walk_run_hysteresis_hz, 0, 1},
      Field{"jump_amplitude_min_mps2", &m.jump_m_from_mps2.from_min, 0.1, 100},
      Field{"jump_amplitude_max_mps2", &m.jump_m_from_mps2.from_max, 0.1, 100},
      Field{"jump_height_min_m", &m.jump_m_from_mps2.to_min, 0.02, 0.5},
      Field{"jump_height_max_m", &m.jump_m_from_mps2.to_max, 0.02, 0.5},
      Field{"jump_frequency_min_hz", &m.jump_mps_from_hz.from_min, 0.1, 10},
      Field{"jump_frequency_max_hz", &m.jump_mps_from_hz.from_max, 0.1, 10},
      Field{"jump_speed_min_mps", &m.jump_mps_from_hz.to_min, 0, 2},
      Field{"jump_speed_max_mps", &m.jump_mps_from_hz.to_max, 0, 2},
      Field{"in_phase_below_deg", &m.in_phase_below_rad, 0, 180, Unit::kDegrees},
      Field{"out_of_phase_above_deg", &m.out_of_phase_above_rad, 0, 180, Unit::kDegrees},
      Field{"turn_above_deg", &m.turn_above_rad, 0, 90, Unit::kDegrees},
      Field{"straight_below_deg", &m.straight_below_rad, 0, 90, Unit::kDegrees},
      Field{"turn_per_step_deg", &m.turn_per_step_rad, 0, biped::kTurnPerStepMaxDeg,
            Unit::kDegrees},
      Field{"hold_s", &m.hold_s, 0, 10},
  };
}

Result<void> ReadField(const json& root, const Field& field, const std::string& origin) {
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

bool Rises(const Scaling& scaling) {
  return scaling.from_min < scaling.from_max && scaling.to_min <= scaling.to_max;
}

}  // namespace

double Scaling::operator()(double from) const {
  const double part = std::clamp((from - from_min) / (from_max - from_min), 0.0, 1.0);
  return to_min + part * (to_max - to_min);
}

Result<WristMapping> ParseWristMapping(const std::string& text, const std::string& origin) {
  const json root = json::parse(text, nullptr, false, true);
  if (!root.is_object()) return InvalidData(origin + ": not a JSON object");
  if (!root.contains("version") || root["version"] != 1) {
    return InvalidData(origin + ": version must be 1, the only one known");
  }
  WristMapping mapping;
  const auto fields = Fields(mapping);
  for (const auto& item : root.items()) {
    const std::string& key = item.key();
    const bool known =
        key == "version" || key == "how_found" ||
        std::any_of(fields.begin(), fields.end(), [&](const Field& f) { return f.key == key; });
    if (!known) return InvalidData(origin + ": unknown key " + key);
  }
  for (const Field& field : fields) {
    if (auto read = ReadField(root, field, origin); !read) return read.error();
  }
  const bool ordered = Rises(mapping.walk_mps_from_hz) && Rises(mapping.run_mps_from_hz) &&
                       Rises(mapping.jump_mps_from_hz) && Rises(mapping.jump_m_from_mps2) &&
                       mapping.in_phase_below_rad <= mapping.out_of_phase_above_rad &&
                       mapping.straight_below_rad <= mapping.turn_above_rad;
  if (!ordered) return InvalidData(origin + ": every _min and _below must lie under its partner");
  return mapping;
}

}  // namespace footing::mapping
