#include "clients/stream/plan.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "clients/stream/script.h"
#include "clients/stream/stick.h"
#include "clients/stream/table.h"
#include "common/runtime/data_file.h"
#include "common/base/units.h"
#include "common/virtual/devices/random.h"
#include "common/virtual/devices/accelerometer.h"
#include "common/virtual/devices/hand_motion.h"

namespace footing::stream_client {
namespace {

using stream::DeviceRole;
using virtual_devices::LinkQuality;

constexpr std::size_t kMaxRecordingBytes = 256u << 20;
/// How fast a person changes from one motion to the next.
constexpr double kBlendS = 0.15;

using Force = std::function<Eigen::Vector3d(double t_s)>;

/// What a real accelerometer adds to a synthetic motion.
Force WithNoise(std::uint64_t seed, Force force) {
  return [random = noise::Random(seed), force](double t_s) mutable {
    const double sd_mps2 = wrists::SensorModel().noise_mps2;
    Eigen::Vector3d felt = force(t_s);
    for (int axis = 0; axis < 3; ++axis) felt[axis] += sd_mps2 * random.Normal();
    return felt;
  };
}

/// Angular velocity of a hand whose gravity in S is `gravity`, without any turn about the vertical:
/// a vector that stands still in the world changes in S as dg/dt = g x w.
Force TurnOf(Force gravity) {
  return [gravity](double t_s) -> Eigen::Vector3d {
    constexpr double kStepS = 0.002;
    const Eigen::Vector3d g = gravity(t_s);
    const Eigen::Vector3d rate = (gravity(t_s + kStepS) - gravity(t_s - kStepS)) / (2 * kStepS);
    return rate.cross(g) / g.squaredNorm();
  };
}

/// Again and again.
Force Repeated(Force force, double duration_s) {
  return [force, duration_s](double t_s) { return force(std::fmod(t_s, duration_s)); };
}

SimulatedDevice::WiimoteMotion Felt(Force force, Force turn = nullptr) {
  return [force, turn](double t_s) {
    virtual_devices::WiimoteSensors sensors;
    sensors.specific_force_S_mps2 = force(t_s);
    if (turn) sensors.angular_velocity_S_radps = turn(t_s);
    return sensors;
  };
}

/// Row i of a recording holds from i / rate to (i + 1) / rate.
Force PlayAccelerations(std::shared_ptr<const Table> table, double rate_hz) {
  return [table, rate_hz](double t_s) {
    const double last = static_cast<double>(table->rows.size() - 1);
    const double index = std::clamp(std::floor(t_s * rate_hz + 1e-6), 0.0, last);
    const auto& row = table->rows[static_cast<std::size_t>(index)];
    return Eigen::Vector3d(row[0], row[1], row[2]);
  };
}

/// Each row holds from its time to the next row's.
SimulatedDevice::CornerForces PlayCorners(std::shared_ptr<const Table> table) {
  return [table](double t_s) {
    const double time_s = table->rows.front()[0] + t_s;
    auto next = std::upper_bound(table->rows.begin(), table->rows.end(), time_s,
                                 [](double time, const auto& row) { return time < row[0]; });
    const auto& row = next == table->rows.begin() ? *next : *std::prev(next);
    return virtual_devices::CornerForces{KilogramsToNewtons(row[1]), KilogramsToNewtons(row[2]),
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

Result<std::vector<wrists::Segment>> ReadScript(const std::string& script) {
  const bool is_path = script.find('/') != std::string::npos || script.ends_with(".json");
  if (!is_path) return ScriptNamed(script);
  const auto text = config::ReadTextFile(script);
  if (!text) return text.error();
  return ParseScript(*text, script);
}

Plan PlanWrists(const std::vector<wrists::Segment>& segments, LinkQuality link,
                const Common& common, const Ports& ports) {
  using wrists::HandMotion;
  const auto make = [](std::vector<wrists::Segment> script) {
    return std::make_shared<const HandMotion>(std::move(script), wrists::WristShape(), kBlendS);
  };
  const auto motion = make(segments);
  // The same without the swing is gravity alone.
  std::vector<wrists::Segment> inclined = segments;
  for (wrists::Segment& segment : inclined) segment.amplitude_mps2 = 0;
  const auto gravity = make(inclined);
  const auto of = [](std::shared_ptr<const HandMotion> hands, bool left) -> Force {
    return [hands, left](double t_s) -> Eigen::Vector3d {
      const wrists::Hands felt = hands->At(t_s);
      return left ? felt.left_mps2 : felt.right_mps2;
    };
  };
  Plan plan;
  for (const bool left : {true, false}) {
    const std::uint64_t device = left ? 1 : 2;
    const double duration_s = motion->DurationSeconds();
    const Force force =
        WithNoise(DeviceSeed(common, device), Repeated(of(motion, left), duration_s));
    const Force turn = Repeated(TurnOf(of(gravity, left)), duration_s);
    const DeviceRole role = left ? DeviceRole::kLeftHand : DeviceRole::kRightHand;
    plan.devices.push_back(MakeWiimote(common, link, device, role, Felt(force, turn), ports));
  }
  return plan;
}

Plan PlanJoystick(const std::vector<wrists::Segment>& segments, LinkQuality link,
                  const Common& common, const Ports& ports) {
  const auto stick = std::make_shared<const StickMotion>(segments, kBlendS);
  const auto still = [](double) { return Eigen::Vector3d(0, 0, -kStandardGravityMps2); };
  const auto motion = [stick, force = WithNoise(DeviceSeed(common, 1), still)](double t_s) mutable {
    const StickState state = stick->At(std::fmod(t_s, stick->DurationSeconds()));
    constexpr std::uint16_t kA = 0x0008;
    virtual_devices::WiimoteSensors sensors;
    sensors.specific_force_S_mps2 = force(t_s);
    sensors.buttons = state.jump ? kA : 0;
    sensors.nunchuk.stick_x = state.x;
    sensors.nunchuk.stick_y = state.y;
    return sensors;
  };
  Plan plan;
  plan.devices.push_back(
      MakeWiimote(common, link, 1, DeviceRole::kRightHand, motion, {ports.motion_plus, true}));
  return plan;
}

}  // namespace

Result<LinkQuality> ParseLink(const std::string& name) {
  if (const auto quality = virtual_devices::LinkNamed(name)) return *quality;
  return UsageError("--link " + name + ": there are ideal, good and poor");
}

std::uint64_t DeviceSeed(const Common& common, std::uint64_t device) {
  return common.seed * 1000 + device;
}

SimulatedDevice MakeWiimote(const Common& common, LinkQuality link, std::uint64_t device,
                            DeviceRole role, SimulatedDevice::WiimoteMotion motion,
                            const Ports& ports) {
  const std::uint64_t seed = DeviceSeed(common, device);
  virtual_devices::Wiimote wiimote(seed);
  if (ports.motion_plus) wiimote.Plug(virtual_devices::Accessory::kMotionPlus, 0);
  if (ports.nunchuk) wiimote.Plug(virtual_devices::Accessory::kNunchuk, 0);
  return {std::move(wiimote), std::move(motion), role,
          virtual_devices::WiimoteLink(link, seed + 500)};
}

Result<Plan> PlanUser(const std::string& script, const std::string& interface, const Common& common,
                      const Ports& ports) {
  if (interface != "wrist" && interface != "joystick") {
    return UsageError(
        "--interface " + interface +
        " needs --see ADDRESS, a user who sees the track, or --ranges; with a script there are: "
        "wrist, joystick");
  }
  const auto link = ParseLink(common.link);
  if (!link) return link.error();
  const auto segments = ReadScript(script);
  if (!segments) return segments.error();
  Plan plan = interface == "wrist" ? PlanWrists(*segments, *link, common, ports)
                                   : PlanJoystick(*segments, *link, common, ports);
  plan.duration_s = Duration(common, 0);
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
                                       Felt(PlayAccelerations(*table, rate_hz))));
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
    plan.devices.emplace_back(virtual_devices::BalanceBoard(seed), PlayCorners(*table), role,
                              virtual_devices::BoardLink(*link, seed + 500));
  }
  plan.duration_s = Duration(common, longest_s);
  return plan;
}

}  // namespace footing::stream_client
