#include "clients/stream/plan.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "clients/stream/script.h"
#include "clients/stream/table.h"
#include "common/config/data_file.h"
#include "common/synthetic/hand_motion.h"
#include "common/synthetic/random.h"
#include "common/synthetic/sensor.h"
#include "common/units/units.h"

namespace footing::stream_client {
namespace {

using device_models::LinkQuality;
using stream::DeviceRole;

constexpr std::size_t kMaxRecordingBytes = 256u << 20;
/// How fast a person changes from one motion to the next.
constexpr double kBlendS = 0.15;

Result<LinkQuality> ParseLink(const std::string& name) {
  if (const auto quality = device_models::LinkNamed(name)) return *quality;
  return UsageError("--link " + name + ": there are ideal, good and poor");
}

/// Seeds of one device, so that no two devices of a run share their random numbers.
std::uint64_t DeviceSeed(const Common& common, std::uint64_t device) {
  return common.seed * 1000 + device;
}

StandIn MakeWiimote(const Common& common, LinkQuality link, std::uint64_t device, DeviceRole role,
                    StandIn::SpecificForce force) {
  const std::uint64_t seed = DeviceSeed(common, device);
  return {device_models::Wiimote(seed), std::move(force), role,
          device_models::WiimoteLink(link, seed + 500)};
}

/// What a real accelerometer adds to a made motion.
StandIn::SpecificForce WithNoise(std::uint64_t seed, StandIn::SpecificForce force) {
  return [random = synthetic::Random(seed), force](double t_s) mutable {
    const double sd_mps2 = synthetic::SensorModel().noise_mps2;
    Eigen::Vector3d felt = force(t_s);
    for (int axis = 0; axis < 3; ++axis) felt[axis] += sd_mps2 * random.Normal();
    return felt;
  };
}

/// Row i of a recording holds from i / rate to (i + 1) / rate.
StandIn::SpecificForce PlayAccelerations(std::shared_ptr<const Table> table, double rate_hz) {
  return [table, rate_hz](double t_s) {
    const double last = static_cast<double>(table->rows.size() - 1);
    const double index = std::clamp(std::floor(t_s * rate_hz + 1e-6), 0.0, last);
    const auto& row = table->rows[static_cast<std::size_t>(index)];
    return Eigen::Vector3d(row[0], row[1], row[2]);
  };
}

/// Each row holds from its time to the next row's.
StandIn::CornerForces PlayCorners(std::shared_ptr<const Table> table) {
  return [table](double t_s) {
    const double time_s = table->rows.front()[0] + t_s;
    auto next = std::upper_bound(table->rows.begin(), table->rows.end(), time_s,
                                 [](double time, const auto& row) { return time < row[0]; });
    const auto& row = next == table->rows.begin() ? *next : *std::prev(next);
    return device_models::CornerForces{KilogramsToNewtons(row[1]), KilogramsToNewtons(row[2]),
                                       KilogramsToNewtons(row[3]), KilogramsToNewtons(row[4])};
  };
}

Result<std::shared_ptr<const Table>> ReadTable(const std::string& path, std::size_t columns) {
  const auto text = config::ReadTextFile(path, kMaxRecordingBytes);
  if (!text) return text.error();
  auto table = ParseTable(*text, columns, path);
  if (!table) return table.error();
  return std::make_shared<const Table>(std::move(table).value());
}

Result<void> CheckTimes(const Table& table, const std::string& path) {
  for (std::size_t i = 1; i < table.rows.size(); ++i) {
    if (table.rows[i][0] < table.rows[i - 1][0]) {
      return InvalidData(path + " row " + std::to_string(i + 1) + ": time goes back");
    }
  }
  return {};
}

double Duration(const Common& common, double natural_s) {
  return common.seconds > 0 ? common.seconds : natural_s;
}

Result<std::vector<synthetic::Segment>> ReadScript(const std::string& script) {
  const bool is_path = script.find('/') != std::string::npos || script.ends_with(".json");
  if (!is_path) return ScriptNamed(script);
  const auto text = config::ReadTextFile(script);
  if (!text) return text.error();
  return ParseScript(*text, script);
}

}  // namespace

Result<Plan> PlanUser(const std::string& script, const std::string& interface,
                      const Common& common) {
  if (interface != "wrist") {
    return UsageError("--interface " + interface + " is not built; there is: wrist");
  }
  const auto link = ParseLink(common.link);
  if (!link) return link.error();
  auto segments = ReadScript(script);
  if (!segments) return segments.error();
  auto motion = std::make_shared<const synthetic::HandMotion>(std::move(segments).value(),
                                                              synthetic::WristShape(), kBlendS);
  auto time = [motion](double t_s) { return std::fmod(t_s, motion->DurationSeconds()); };
  Plan plan;
  plan.duration_s = Duration(common, 0);
  plan.devices.push_back(MakeWiimote(common, *link, 1, DeviceRole::kLeftHand,
                                     WithNoise(DeviceSeed(common, 1), [motion, time](double t_s) {
                                       return motion->At(time(t_s)).left_mps2;
                                     })));
  plan.devices.push_back(MakeWiimote(common, *link, 2, DeviceRole::kRightHand,
                                     WithNoise(DeviceSeed(common, 2), [motion, time](double t_s) {
                                       return motion->At(time(t_s)).right_mps2;
                                     })));
  return plan;
}

Result<Plan> PlanAccelerations(const std::string& left, const std::string& right, double rate_hz,
                               const Common& common) {
  const auto link = ParseLink(common.link);
  if (!link) return link.error();
  if (!(rate_hz >= 1 && rate_hz <= 1000)) return UsageError("--rate-hz must be from 1 to 1000");
  Plan plan;
  double longest_s = 0;
  const std::pair<std::string, DeviceRole> hands[] = {{left, DeviceRole::kLeftHand},
                                                      {right, DeviceRole::kRightHand}};
  for (const auto& [path, role] : hands) {
    if (path.empty()) continue;
    const auto table = ReadTable(path, 3);
    if (!table) return table.error();
    longest_s = std::max(longest_s, static_cast<double>((*table)->rows.size()) / rate_hz);
    plan.devices.push_back(MakeWiimote(common, *link, plan.devices.size() + 1, role,
                                       PlayAccelerations(*table, rate_hz)));
  }
  plan.duration_s = Duration(common, longest_s);
  return plan;
}

Result<Plan> PlanCorners(const std::string& left, const std::string& right, const Common& common) {
  const auto link = ParseLink(common.link);
  if (!link) return link.error();
  Plan plan;
  double longest_s = 0;
  const std::pair<std::string, DeviceRole> boards[] = {{left, DeviceRole::kLeftBoard},
                                                       {right, DeviceRole::kRightBoard}};
  for (const auto& [path, role] : boards) {
    if (path.empty()) continue;
    const auto table = ReadTable(path, 5);
    if (!table) return table.error();
    if (const auto times = CheckTimes(**table, path); !times) return times.error();
    longest_s = std::max(longest_s, (*table)->rows.back()[0] - (*table)->rows.front()[0]);
    const std::uint64_t seed = DeviceSeed(common, plan.devices.size() + 1);
    plan.devices.emplace_back(device_models::BalanceBoard(seed), PlayCorners(*table), role,
                              device_models::BoardLink(*link, seed + 500));
  }
  plan.duration_s = Duration(common, longest_s);
  return plan;
}

}  // namespace footing::stream_client
