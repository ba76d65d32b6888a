#include "daemon/simulation/mapping/mapping_table.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/base/json_text.h"
#include "common/base/units.h"

namespace footing::mapping {
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

}  // namespace footing::mapping
