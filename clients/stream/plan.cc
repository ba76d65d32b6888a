#include "clients/stream/plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include <Eigen/Geometry>

#include "clients/stream/samples.h"
#include "clients/stream/simulated_device.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/recording/recorded_session.h"
#include "common/runtime/files.h"
#include "common/runtime/log.h"
#include "common/virtual/devices/accelerometer.h"
#include "common/virtual/devices/joycon.h"
#include "common/virtual/devices/noise.h"

namespace footing::stream_client {
namespace {

using stream::DeviceRole;
using virtual_devices::LinkQuality;

constexpr std::size_t kMaxRecordingBytes = 256u << 20;
/// How fast a person changes from one motion to the next.
constexpr double kBlendS = 0.15;

using Force = std::function<Eigen::Vector3d(double t_s)>;

/// Adds a Wiimote's noise to a synthetic motion.
Force WithNoise(std::uint64_t seed, const Held& held, Force force) {
  if (held.kind != HeldKind::kWiimote) return force;
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
                const Common& common, const Held& held) {
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
        WithNoise(DeviceSeed(common, device), held, Repeated(of(motion, left), duration_s));
    const Force turn = Repeated(TurnOf(of(gravity, left)), duration_s);
    const DeviceRole role = left ? DeviceRole::kLeftHand : DeviceRole::kRightHand;
    plan.devices.push_back(MakeRemote(common, link, device, role, Felt(force, turn), held));
  }
  return plan;
}

Plan PlanJoystick(const std::vector<wrists::Segment>& segments, LinkQuality link,
                  const Common& common, const Held& held) {
  const auto stick = std::make_shared<const StickMotion>(segments, kBlendS);
  const auto still = [](double) { return Eigen::Vector3d(0, 0, -kStandardGravityMps2); };
  const auto motion = [stick,
                       force = WithNoise(DeviceSeed(common, 1), held, still)](double t_s) mutable {
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
  plan.devices.push_back(MakeRemote(common, link, 1, DeviceRole::kRightHand, motion,
                                    {held.kind, held.motion_plus, true}));
  return plan;
}

/// A Joy-Con moved as a Wiimote is; its stick stands for the Nunchuk's, its A or L for the button
/// A.
SimulatedDevice::JoyconMotion AsJoycon(SimulatedDevice::WiimoteMotion motion, std::uint64_t seed) {
  return [motion = std::move(motion), random = noise::Random(seed)](double t_s) mutable {
    constexpr std::uint16_t kWiimoteA = 0x0008;
    const virtual_devices::WiimoteSensors felt = motion(std::max(0.0, t_s));
    virtual_devices::JoyconSensors sensors;
    sensors.specific_force_S_mps2 = felt.specific_force_S_mps2;
    sensors.angular_velocity_S_radps = felt.angular_velocity_S_radps;
    sensors.stick_x = felt.nunchuk.stick_x;
    sensors.stick_y = felt.nunchuk.stick_y;
    sensors.buttons =
        (felt.buttons & kWiimoteA) != 0 ? virtual_devices::kJoyconA | virtual_devices::kJoyconL : 0;
    return virtual_devices::WithNoise(sensors, random);
  };
}

}  // namespace

Result<HeldKind> HeldKindNamed(const std::string& name) {
  if (name == "wiimote") return HeldKind::kWiimote;
  if (name == "joycon") return HeldKind::kJoycon;
  return UsageError("--devices " + name + ": there are wiimote and joycon");
}

Result<LinkQuality> ParseLink(const std::string& name) {
  if (const auto quality = virtual_devices::LinkNamed(name)) return *quality;
  return UsageError("--link " + name + ": there are ideal, good and poor");
}

std::uint64_t DeviceSeed(const Common& common, std::uint64_t device) {
  return common.seed * 1000 + device;
}

SimulatedDevice MakeRemote(const Common& common, LinkQuality link, std::uint64_t device,
                           DeviceRole role, SimulatedDevice::WiimoteMotion motion,
                           const Held& held) {
  const std::uint64_t seed = DeviceSeed(common, device);
  if (held.kind == HeldKind::kJoycon) {
    const bool right = role == DeviceRole::kRightHand || role == DeviceRole::kRightLeg;
    return {virtual_devices::Joycon(seed, right ? virtual_devices::JoyconModel::kRight
                                                : virtual_devices::JoyconModel::kLeft),
            AsJoycon(std::move(motion), seed), role, virtual_devices::JoyconLink(link, seed + 500)};
  }
  virtual_devices::Wiimote wiimote(seed);
  if (held.motion_plus) wiimote.Plug(virtual_devices::Accessory::kMotionPlus, 0);
  if (held.nunchuk) wiimote.Plug(virtual_devices::Accessory::kNunchuk, 0);
  return {std::move(wiimote), std::move(motion), role,
          virtual_devices::WiimoteLink(link, seed + 500)};
}

Result<Plan> PlanUser(const std::string& script, const std::string& interface, const Common& common,
                      const Held& held) {
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
  Plan plan = interface == "wrist" ? PlanWrists(*segments, *link, common, held)
                                   : PlanJoystick(*segments, *link, common, held);
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
    plan.devices.push_back(MakeRemote(common, *link, plan.devices.size() + 1, role,
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

Result<Table> ParseTable(const std::string& text, std::size_t columns, const std::string& origin) {
  Table table;
  text::Lines lines(text, origin);
  bool first = true;
  while (const auto line = lines.NextFull()) {
    const bool header = first && !text::ToNumber(text::Cells(*line)[0]);
    first = false;
    if (header) continue;
    auto row = text::NumberRow(*line, columns);
    if (!row) return lines.Fault(row.error().message);
    table.rows.push_back(std::move(row).value());
  }
  if (table.rows.empty()) return InvalidData(origin + " holds no rows");
  return table;
}

namespace {

constexpr double kWalkRadius = 0.45;  // Well inside 0.6 of figure 11.
constexpr double kRunRadius = 0.9;
constexpr double kRunFrequencyHz = 2;  // From here on the wrists command a run.
/// The wrists turn by 20 degrees of inclination; the stick goes to 60 for it.
constexpr double kStickPerRoll = 3;
constexpr double kMaxAngleRad = 75 * kPi / 180;
constexpr double kPressS = 0.1;

bool Jumps(const wrists::Segment& segment) {
  return segment.amplitude_mps2 > 0 && std::abs(WrapAngle(segment.phase_rad)) < kPi / 2;
}

/// Where the stick stands in this stretch: right, front.
std::pair<double, double> Place(const wrists::Segment& segment) {
  if (segment.amplitude_mps2 == 0) return {0, 0};
  const bool runs = !Jumps(segment) && segment.frequency_hz > kRunFrequencyHz;
  const double radius = runs ? kRunRadius : kWalkRadius;
  const double angle_rad =
      std::clamp(kStickPerRoll * segment.roll_rad, -kMaxAngleRad, kMaxAngleRad);
  return {radius * std::sin(angle_rad), radius * std::cos(angle_rad)};
}

}  // namespace

StickMotion::StickMotion(std::vector<wrists::Segment> segments, double blend_s)
    : segments_(std::move(segments)), blend_s_(blend_s) {
  for (const wrists::Segment& segment : segments_) duration_s_ += segment.duration_s;
}

StickState StickMotion::At(double t_s) const {
  double into_s = std::max(0.0, t_s);
  std::size_t i = 0;
  for (; i + 1 < segments_.size() && into_s >= segments_[i].duration_s; ++i) {
    into_s -= segments_[i].duration_s;
  }
  const wrists::Segment& segment = segments_[i];
  const auto [from_x, from_y] = Place(segments_[i == 0 ? 0 : i - 1]);
  const auto [x, y] = Place(segment);
  const double share = into_s < blend_s_ ? into_s / blend_s_ : 1;
  StickState state;
  state.x = from_x + (x - from_x) * share;
  state.y = from_y + (y - from_y) * share;
  state.jump = Jumps(segment) && std::fmod(into_s, 1 / segment.frequency_hz) < kPressS;
  return state;
}

namespace {

constexpr int kRepeats = 12;
constexpr double kLeastHeldS = 1.0, kMostHeldS = 1.8;
constexpr double kLeastRad = 15 * kPi / 180, kMostRad = 45 * kPi / 180;
constexpr double kGripChangeS = 0.25;
/// Button bits of the Wiimote.
constexpr std::uint16_t kButtonA = 0x0008, kButtonB = 0x0004;

/// Signs of roll and pitch, and the buttons.
std::vector<BuilderGrip> Kinds(bool pits) {
  std::vector<BuilderGrip> kinds{{0, 1}, {0, -1}, {1, 0}, {-1, 0}, {0, 1, true}, {0, -1, true}, {}};
  if (pits) kinds.push_back({0, 0, false, true});
  return kinds;
}

}  // namespace

BuilderScript::BuilderScript(std::uint64_t seed, bool pits) {
  noise::Random random(seed);
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    std::vector<BuilderGrip> kinds = Kinds(pits);
    while (!kinds.empty()) {
      const auto drawn =
          std::min(kinds.size() - 1,
                   static_cast<std::size_t>(random.Uniform(0, static_cast<double>(kinds.size()))));
      BuilderGrip grip = kinds[drawn];
      kinds.erase(kinds.begin() + static_cast<std::ptrdiff_t>(drawn));
      const double inclination_rad = random.Uniform(kLeastRad, kMostRad);
      grip.roll_rad *= inclination_rad;
      grip.pitch_rad *= inclination_rad;
      stretches_.push_back({duration_s_, grip});
      duration_s_ += random.Uniform(kLeastHeldS, kMostHeldS);
    }
  }
}

BuilderGrip BuilderScript::At(double t_s) const {
  const double into_s = std::fmod(std::max(0.0, t_s), duration_s_);
  std::size_t i = 0;
  while (i + 1 < stretches_.size() && stretches_[i + 1].from_s <= into_s) ++i;
  const BuilderGrip& before = stretches_[i == 0 ? stretches_.size() - 1 : i - 1].grip;
  BuilderGrip grip = stretches_[i].grip;
  const double share = std::min(1.0, (into_s - stretches_[i].from_s) / kGripChangeS);
  grip.roll_rad = before.roll_rad + share * (grip.roll_rad - before.roll_rad);
  grip.pitch_rad = before.pitch_rad + share * (grip.pitch_rad - before.pitch_rad);
  return grip;
}

Result<Plan> PlanBuilder(bool pits, const Common& common) {
  const auto link = ParseLink(common.link);
  if (!link) return link.error();
  const std::uint64_t seed = DeviceSeed(common, 3);
  const auto script = std::make_shared<const BuilderScript>(seed, pits);
  const auto motion = [script, random = noise::Random(seed)](double t_s) mutable {
    const BuilderGrip grip = script->At(t_s);
    virtual_devices::WiimoteSensors sensors;
    sensors.specific_force_S_mps2 = wrists::InclinedGravity(grip.roll_rad, grip.pitch_rad);
    for (int axis = 0; axis < 3; ++axis) {
      sensors.specific_force_S_mps2[axis] += wrists::SensorModel().noise_mps2 * random.Normal();
    }
    sensors.buttons = static_cast<std::uint16_t>((grip.a ? kButtonA : 0) | (grip.b ? kButtonB : 0));
    return sensors;
  };
  Plan plan;
  plan.devices.push_back(MakeRemote(common, *link, 3, stream::DeviceRole::kEditor, motion));
  plan.duration_s = common.seconds;
  return plan;
}

namespace {

constexpr double kNever_s = std::numeric_limits<double>::infinity();
/// After the last report, so that its tick is made before the devices detach.
constexpr double kAfterLast_s = 0.1;

/// One stay of a device: from when it attached until it was lost.
struct Stay {
  v1::DeviceStatus status;
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
  bool lost = false;
  std::vector<RecordedReport> reports;
};

/// Collects the stays of all devices out of footingd's ticks.
class StayCollector {
 public:
  void Take(const v1::Tick& tick) {
    for (const v1::RawReport& raw : tick.raw().reports()) Take(raw);
    for (const v1::DeviceStatus& status : tick.status().devices()) {
      Stay* const stay = Current(status.device());
      if (status.state() == v1::DEVICE_STATE_LOST) {
        if (stay != nullptr) stay->lost = true;
      } else {
        statuses_[status.device()] = status;
        // The kind of a device becomes known as it answers.
        if (stay != nullptr) stay->status = status;
      }
    }
  }

  std::vector<Stay>& stays() { return stays_; }

 private:
  Stay* Current(std::uint32_t device) {
    const auto found = current_.find(device);
    if (found == current_.end() || stays_[found->second].lost) return nullptr;
    return &stays_[found->second];
  }

  void Take(const v1::RawReport& raw) {
    Stay* stay = Current(raw.device());
    if (stay == nullptr) {
      current_[raw.device()] = stays_.size();
      stay = &stays_.emplace_back();
      stay->first_ns = raw.received_ns();
      stay->status = statuses_[raw.device()];
    }
    stay->last_ns = std::max(stay->last_ns, raw.received_ns());
    RecordedReport report;
    report.time_s = NanosecondsToSeconds(raw.received_ns());  // From the start: see Plan.
    report.bytes.assign(raw.report().begin(), raw.report().end());
    report.to_device = raw.to_device();
    report.feature = raw.feature();
    stay->reports.push_back(std::move(report));
  }

  std::vector<Stay> stays_;
  std::map<std::uint32_t, std::size_t> current_;  ///< Newest stay of each device.
  std::map<std::uint32_t, v1::DeviceStatus> statuses_;
};

SimulatedDevice MakeDevice(Stay& stay, std::int64_t start_ns) {
  const double start_s = NanosecondsToSeconds(start_ns);
  for (RecordedReport& report : stay.reports) {
    v1::RawReport raw;
    raw.set_report(report.bytes.data(), report.bytes.size());
    raw.set_to_device(report.to_device);
    raw.set_feature(report.feature);
    report.feature = recording::IsFeature(raw, stay.status);
    report.time_s -= start_s;
  }
  const recording::RecordedIdentity recorded = recording::IdentityOf(stay.status);
  const std::string& stored = stay.status.stored_calibration();
  RecordedDevice device(
      {recorded.bus, recorded.vendor, recorded.product, recorded.name, recorded.serial},
      NanosecondsToSeconds(stay.first_ns - start_ns),
      stay.lost ? NanosecondsToSeconds(stay.last_ns - start_ns) : kNever_s, stay.reports,
      {stored.begin(), stored.end()});
  if (!device.has_handshake()) {
    log::Warning("the recording begins after " + recorded.serial +
                 " was set up: its calibration is not in it");
  }
  return SimulatedDevice(std::move(device), static_cast<stream::DeviceRole>(stay.status.role()));
}

}  // namespace

Result<Plan> PlanReplay(const std::string& path, const Common& common) {
  const auto session = recording::RecordedSession::Open(path);
  if (!session) return session.error();
  const recording::RecordedServer* server = session->Find("footingd");
  if (server == nullptr) return InvalidData(path + " has no messages of footingd");
  StayCollector collector;
  for (const recording::RecordedTick& recorded : server->ticks) {
    const auto tick =
        recording::ReadTick(recorded, {v1::Tick::kStatusFieldNumber, v1::Tick::kRawFieldNumber});
    if (!tick) return InvalidData(path + ": " + tick.error().message);
    collector.Take(*tick);
  }
  std::vector<Stay>& stays = collector.stays();
  std::erase_if(stays, [](const Stay& stay) { return stay.status.serial().empty(); });
  if (stays.empty()) return InvalidData(path + " holds no raw report of a device");
  const auto by_start = [](const Stay& a, const Stay& b) { return a.first_ns < b.first_ns; };
  const std::int64_t start_ns = std::min_element(stays.begin(), stays.end(), by_start)->first_ns;
  Plan plan;
  for (Stay& stay : stays) {
    plan.devices.push_back(MakeDevice(stay, start_ns));
    plan.duration_s =
        std::max(plan.duration_s, NanosecondsToSeconds(stay.last_ns - start_ns) + kAfterLast_s);
  }
  plan.duration_s /= common.rate_scale;
  if (common.seconds > 0) plan.duration_s = std::min(plan.duration_s, common.seconds);
  return plan;
}

}  // namespace footing::stream_client
