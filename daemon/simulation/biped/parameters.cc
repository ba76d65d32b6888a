#include "daemon/simulation/biped/parameters.h"
#include "common/base/json_text.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace footing::biped {
namespace {

struct Field {
  const char* key;
  double BipedParameters::*value;
  double min, max;
};

using P = BipedParameters;
constexpr std::array kFields{
    Field{"body_mass_kg", &P::body_mass_kg, 1, 100},
    Field{"body_inertia_roll_kgm2", &P::body_inertia_roll_kgm2, 0.01, 20},
    Field{"body_inertia_pitch_kgm2", &P::body_inertia_pitch_kgm2, 0.01, 20},
    Field{"body_inertia_yaw_kgm2", &P::body_inertia_yaw_kgm2, 0.01, 20},
    Field{"link_mass_kg", &P::link_mass_kg, 0.01, 20},
    Field{"link_inertia_across_kgm2", &P::link_inertia_across_kgm2, 1e-4, 5},
    Field{"link_inertia_along_kgm2", &P::link_inertia_along_kgm2, 1e-5, 5},
    Field{"leg_length_m", &P::leg_length_m, 0.3, 2},
    Field{"leg_length_min_m", &P::leg_length_min_m, 0.1, 2},
    Field{"leg_length_max_m", &P::leg_length_max_m, 0.3, 3},
    Field{"hip_half_spacing_m", &P::hip_half_spacing_m, 0, 0.5},
    Field{"hip_below_body_com_m", &P::hip_below_body_com_m, -0.5, 0.5},
    Field{"hip_link_com_below_hip_m", &P::hip_link_com_below_hip_m, 0, 1},
    Field{"foot_below_knee_link_com_m", &P::foot_below_knee_link_com_m, 0, 1},
    Field{"foot_radius_m", &P::foot_radius_m, 0.005, 0.1},
    Field{"sliding_friction", &P::sliding_friction, 0.1, 5},
    Field{"torsional_friction_m", &P::torsional_friction_m, 0.001, 0.5},
    Field{"hip_armature_kgm2", &P::hip_armature_kgm2, 0, 1},
};

bool Known(const std::string& key) {
  return key == "version" || key == "name" ||
         std::any_of(kFields.begin(), kFields.end(), [&](const Field& f) { return f.key == key; });
}

}  // namespace

Result<BipedParameters> ParseBiped(const std::string& text, const std::string& origin) {
  const auto read = text::ParseJson(text, origin);
  if (!read) return read.error();
  const auto& root = *read;
  if (!root.is_object()) return InvalidData(origin + ": not a JSON object");
  if (!root.contains("version") || root["version"] != 1) {
    return InvalidData(origin + ": version must be 1, the only one known");
  }
  for (const auto& [key, value] : root.items()) {
    if (!Known(key)) return InvalidData(origin + ": unknown key " + key);
  }
  BipedParameters parameters;
  for (const Field& field : kFields) {
    if (!root.contains(field.key)) return InvalidData(origin + ": " + field.key + " is missing");
    const auto& value = root[field.key];
    if (!value.is_number() || value < field.min || value > field.max) {
      return InvalidData(origin + ": " + field.key + " is " + value.dump() + ", allowed is " +
                         std::to_string(field.min) + " to " + std::to_string(field.max));
    }
    parameters.*field.value = value;
  }
  const bool ordered = parameters.leg_length_min_m < parameters.leg_length_m &&
                       parameters.leg_length_m < parameters.leg_length_max_m;
  if (!ordered) {
    return InvalidData(origin + ": leg_length_m must lie between leg_length_min_m and _max_m");
  }
  return parameters;
}

}  // namespace footing::biped
