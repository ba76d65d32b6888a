#include "common/virtual/devices/wiimote.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/units.h"
#include "common/virtual/devices/random.h"

namespace footing::virtual_devices {
namespace {

/// Raw axes point left, rear and up; S has left, front and down.
constexpr std::array<double, 3> kRawSigns = {+1, -1, -1};

/// In low..high, both included.
std::array<Wiimote::Axis, 3> DrawAxes(std::uint64_t seed) {
  // Around what real units have: zero near 521 and 532, 1 g 105 to 111 above it.
  noise::Random random(seed);
  std::array<Wiimote::Axis, 3> axes;
  for (Wiimote::Axis& axis : axes) {
    axis.zero_counts = random.Integer(505, 535);
    axis.one_g_counts = axis.zero_counts + random.Integer(103, 112);
  }
  return axes;
}

/// Upper bytes of x, y, z, then their low bits in one byte.
void PutTenBits(std::span<std::uint8_t> out, int x, int y, int z) {
  out[0] = static_cast<std::uint8_t>(x >> 2);
  out[1] = static_cast<std::uint8_t>(y >> 2);
  out[2] = static_cast<std::uint8_t>(z >> 2);
  out[3] = static_cast<std::uint8_t>((x & 3) << 4 | (y & 3) << 2 | (z & 3));
}

/// The last byte of a block: the sum of the others and 0x55.
void PutChecksum(std::span<std::uint8_t> block) {
  std::uint8_t sum = 0x55;
  for (const std::uint8_t byte : block.first(block.size() - 1)) {
    sum = static_cast<std::uint8_t>(sum + byte);
  }
  block.back() = sum;
}

AccelerationBlock DrawAcceleration(std::uint64_t seed) {
  const auto axes = DrawAxes(seed);
  AccelerationBlock block{};
  PutTenBits(block, axes[0].zero_counts, axes[1].zero_counts, axes[2].zero_counts);
  PutTenBits(std::span(block).subspan(4), axes[0].one_g_counts, axes[1].one_g_counts,
             axes[2].one_g_counts);
  block[8] = 0x40;  // Speaker volume.
  PutChecksum(block);
  return block;
}

std::array<Wiimote::Axis, 3> AxesOf(const AccelerationBlock& block) {
  std::array<Wiimote::Axis, 3> axes;
  for (std::size_t i = 0; i < 3; ++i) {
    axes[i].zero_counts = block[i] << 2 | (block[3] >> (4 - 2 * i) & 3);
    axes[i].one_g_counts = block[4 + i] << 2 | (block[7] >> (4 - 2 * i) & 3);
  }
  return axes;
}

Memory MakeMemory(const AccelerationBlock& acceleration) {
  Memory memory(false);
  // Camera calibration of a real unit; two copies.
  constexpr std::uint8_t kCamera[] = {0xa1, 0xaa, 0x8b, 0x99, 0xae, 0x9e, 0x78, 0x30, 0xa7, 0x74};
  for (const std::size_t at : {0x00u, 0x0bu}) {
    const auto block = memory.eeprom().subspan(at, 11);
    std::copy(std::begin(kCamera), std::end(kCamera), block.begin());
    PutChecksum(block);
  }
  for (const std::size_t at : {0x16u, 0x20u}) {
    std::copy(acceleration.begin(), acceleration.end(), memory.eeprom().subspan(at).begin());
  }
  return memory;
}

constexpr int kRubbishPackets = 2;
constexpr std::uint8_t kErrorBusy = 2;
constexpr ExtensionBytes kNoAnswer = {0xff, 0xff, 0xff, 0xff, 0xff, 0xff};

}  // namespace

Wiimote::Wiimote(std::uint64_t seed, const WiimoteOptions& options)
    : nunchuk_(options.nunchuk.value_or(DrawNunchukBlock(seed + 1))),
      motion_plus_(options.motion_plus.value_or(DrawMotionPlusBlock(seed + 2))),
      motion_plus_inside_(options.tr || options.motion_plus_inside),
      controller_(Memory(false)) {
  const AccelerationBlock acceleration = options.acceleration.value_or(DrawAcceleration(seed));
  axes_ = AxesOf(acceleration);
  controller_ = Controller(MakeMemory(acceleration));
  if (motion_plus_inside_) {
    controller_.memory().SetMotionPlus(MotionPlusPage(motion_plus_, true));
  }
  identity_.name = options.tr ? "Nintendo RVL-CNT-01-TR" : "Nintendo RVL-CNT-01";
  if (options.tr) identity_.product = stream::kProductTr;
  identity_.serial = MakeSerial(SerialOf::kWiimote, seed);
}

std::vector<Report> Wiimote::Plug(Accessory accessory, std::int64_t now_ns) {
  std::vector<Report> reports;
  Advance(now_ns, reports);
  Memory& memory = controller_.memory();
  if (accessory == Accessory::kMotionPlus) {
    // Inactive, it does not show: the port goes on to what is behind it.
    if (!has_motion_plus()) memory.SetMotionPlus(MotionPlusPage(motion_plus_, false));
    return reports;
  }
  child_ = accessory;
  const bool shows = !motion_plus_active();
  switch (accessory) {
    case Accessory::kNunchuk:
      memory.SetExtension(NunchukPage(nunchuk_));
      break;
    case Accessory::kClassic:
      memory.SetExtension(ClassicPage());
      break;
    case Accessory::kUnknown:
      memory.SetExtension(UnknownPage());
      break;
    case Accessory::kNone:
    case Accessory::kMotionPlus:
      memory.SetExtension({});
      break;
  }
  if (shows) reports.push_back(controller_.UnaskedStatus());
  return reports;
}

std::vector<Report> Wiimote::Pull(std::int64_t now_ns) {
  if (child_ != Accessory::kNone) return Plug(Accessory::kNone, now_ns);
  return motion_plus_inside_ ? std::vector<Report>{} : PullMotionPlus(now_ns);
}

std::vector<Report> Wiimote::PullMotionPlus(std::int64_t now_ns) {
  std::vector<Report> reports;
  Advance(now_ns, reports);
  if (!has_motion_plus()) return reports;
  const bool showed = controller_.memory().has_extension();
  controller_.memory().SetMotionPlus({});
  controller_.memory().SetExtension({});
  child_ = Accessory::kNone;
  dead_until_ns_.reset();
  controller_.memory().set_port_ready(true);
  if (showed) reports.push_back(controller_.UnaskedStatus());
  return reports;
}

void Wiimote::TakePortAway(std::int64_t now_ns, std::vector<Report>& reports) {
  controller_.memory().set_port_ready(false);
  dead_until_ns_ = now_ns + kDeadNs;
  rubbish_packets_ = kRubbishPackets;
  child_turn_ = false;
  reports.push_back(controller_.UnaskedStatus());
}

void Wiimote::Advance(std::int64_t now_ns, std::vector<Report>& reports) {
  if (!dead_until_ns_ || now_ns < *dead_until_ns_) return;
  dead_until_ns_.reset();
  controller_.memory().set_port_ready(true);
  if (controller_.memory().has_extension()) reports.push_back(controller_.UnaskedStatus());
}

std::vector<Report> Wiimote::HandleOutput(std::int64_t now_ns,
                                          std::span<const std::uint8_t> report) {
  std::vector<Report> reports;
  Advance(now_ns, reports);
  if (refusals_ > 0 && !report.empty() && (report[0] == 0x15 || report[0] == 0x17)) {
    --refusals_;
    reports.push_back({0x22, 0x00, 0x00, report[0], kErrorBusy});
    return reports;
  }
  const bool was_active = motion_plus_active();
  for (Report& answer : controller_.HandleOutput(report)) reports.push_back(std::move(answer));
  if (motion_plus_active() != was_active) TakePortAway(now_ns, reports);
  return reports;
}

std::vector<Report> Wiimote::Sample(std::int64_t now_ns, const WiimoteSensors& sensors) {
  std::vector<Report> reports;
  Advance(now_ns, reports);
  if (auto data = controller_.DataReport(Read(sensors))) reports.push_back(std::move(*data));
  return reports;
}

std::vector<Report> Wiimote::HandleOutput(std::span<const std::uint8_t> report) {
  auto reports = HandleOutput(0, report);
  Advance(kDeadNs, reports);
  return reports;
}

std::optional<Report> Wiimote::Sample(const Eigen::Vector3d& specific_force_S_mps2,
                                      std::uint16_t buttons) {
  WiimoteSensors sensors;
  sensors.specific_force_S_mps2 = specific_force_S_mps2;
  sensors.buttons = buttons;
  return controller_.DataReport(Read(sensors));
}

Readings Wiimote::Read(const WiimoteSensors& sensors) {
  Readings readings;
  readings.buttons = sensors.buttons;
  readings.camera = sensors.camera;
  for (std::size_t i = 0; i < 3; ++i) {
    const double force = kRawSigns[i] * sensors.specific_force_S_mps2[static_cast<Eigen::Index>(i)];
    const double g = std::isfinite(force) ? force / kStandardGravityMps2 : 0;
    const double counts = axes_[i].zero_counts + g * (axes_[i].one_g_counts - axes_[i].zero_counts);
    // y and z are sent with 9 bits: their counts are even.
    const double step = i == 0 ? 1 : 2;
    const double rounded = step * std::round(counts / step);
    readings.acceleration_counts[i] =
        static_cast<std::uint16_t>(std::clamp(rounded, 0.0, i == 0 ? 1023.0 : 1022.0));
  }
  readings.extension.fill(controller_.memory().has_extension() ? 0x00 : 0xff);
  // Only modes that carry it take a packet.
  const ExtensionBytes packet =
      CarriesExtension(controller_.mode()) ? ExtensionPacket(sensors) : kNoAnswer;
  std::copy(packet.begin(), packet.end(), readings.extension.begin());
  return readings;
}

ExtensionBytes Wiimote::ExtensionPacket(const WiimoteSensors& sensors) {
  const Memory& memory = controller_.memory();
  if (!memory.has_extension()) return kNoAnswer;
  if (memory.motion_plus_mode() != 0) return PassedPacket(sensors);
  if (!memory.extension_plain()) return kNoAnswer;
  if (child_ == Accessory::kNunchuk) return NunchukBytes(nunchuk_, sensors.nunchuk);
  if (child_ == Accessory::kClassic) return ClassicBytes(sensors.classic);
  return {};
}

/// Of an active MotionPlus: its own and the child's in turn.
ExtensionBytes Wiimote::PassedPacket(const WiimoteSensors& sensors) {
  if (rubbish_packets_ > 0) return --rubbish_packets_ > 0 ? kNoAnswer : ExtensionBytes{};
  const std::uint8_t mode = controller_.memory().motion_plus_mode();
  const bool passes =
      (mode == 5 && child_ == Accessory::kNunchuk) || (mode == 7 && child_ == Accessory::kClassic);
  child_turn_ = passes && !child_turn_;
  if (!child_turn_) {
    return MotionPlusBytes(motion_plus_, sensors.angular_velocity_S_radps,
                           child_ != Accessory::kNone);
  }
  return mode == 5 ? PassedNunchuk(NunchukBytes(nunchuk_, sensors.nunchuk))
                   : PassedClassic(ClassicBytes(sensors.classic));
}

}  // namespace footing::virtual_devices
