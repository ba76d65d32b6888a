#include "common/device_models/wiimote.h"

#include <algorithm>
#include <cmath>

#include "common/synthetic/random.h"

namespace footing::device_models {
namespace {

constexpr std::int64_t kDeadWindowNs = 20'000'000;
constexpr std::uint16_t kProductTr = 0x0330;

/// Raw axes point left, rear and up; S has left, front and down.
constexpr std::array<double, 3> kRawSigns = {+1, -1, -1};

/// In low..high, both included.
int Integer(synthetic::Random& random, int low, int high) {
  return low + static_cast<int>(random.Uniform() * (high - low + 1));
}

std::array<Wiimote::Axis, 3> DrawAxes(std::uint64_t seed) {
  // Around what real units have: zero near 521 and 532, 1 g 105 to 111 above it.
  synthetic::Random random(seed);
  std::array<Wiimote::Axis, 3> axes;
  for (Wiimote::Axis& axis : axes) {
    axis.zero_counts = Integer(random, 505, 535);
    axis.one_g_counts = axis.zero_counts + Integer(random, 103, 112);
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

Memory MakeMemory(const std::array<Wiimote::Axis, 3>& axes) {
  Memory memory(false);
  // Camera calibration: plausible positions; two copies.
  constexpr std::uint8_t kCamera[] = {0xa1, 0xaa, 0x8b, 0x99, 0xae, 0x9e, 0x78, 0x30, 0xa7, 0x74};
  for (const std::size_t at : {0x00u, 0x0bu}) {
    const auto block = memory.eeprom().subspan(at, 11);
    std::copy(std::begin(kCamera), std::end(kCamera), block.begin());
    PutChecksum(block);
  }
  for (const std::size_t at : {0x16u, 0x20u}) {
    const auto block = memory.eeprom().subspan(at, 10);
    PutTenBits(block, axes[0].zero_counts, axes[1].zero_counts, axes[2].zero_counts);
    PutTenBits(block.subspan(4), axes[0].one_g_counts, axes[1].one_g_counts, axes[2].one_g_counts);
    block[8] = 0x40;  // Speaker volume.
    PutChecksum(block);
  }
  return memory;
}

}  // namespace

Wiimote::Wiimote(std::uint64_t seed, const WiimoteOptions& options)
    : axes_(DrawAxes(seed)),
      nunchuk_block_(DrawNunchukBlock(seed + 1)),
      motion_plus_block_(DrawMotionPlusBlock(seed + 2)),
      options_(options),
      controller_(MakeMemory(axes_)) {
  identity_.name = options.tr ? "Nintendo RVL-CNT-01-TR" : "Nintendo RVL-CNT-01";
  if (options.tr) {
    identity_.product = kProductTr;
    options_.motion_plus_inside = true;
  }
  identity_.serial = MakeSerial(seed);
  if (options_.motion_plus_inside) {
    controller_.memory().SetMotionPlus(MotionPlusPage(motion_plus_block_, true));
  }
}

std::vector<Report> Wiimote::Plug(Accessory accessory, std::int64_t now_ns) {
  std::vector<Report> out = Due(now_ns);
  Memory& memory = controller_.memory();
  const bool said = memory.has_extension();
  switch (accessory) {
    case Accessory::kNone:
      return out;
    case Accessory::kMotionPlus:
      if (memory.has_motion_plus()) return out;
      memory.SetMotionPlus(MotionPlusPage(motion_plus_block_, false));
      if (said) out.push_back(controller_.UnaskedStatus());  // The child was out for a moment.
      return out;
    case Accessory::kNunchuk:
      memory.SetExtension(NunchukPage(nunchuk_block_));
      break;
    case Accessory::kClassic:
      memory.SetExtension(ClassicPage());
      break;
    case Accessory::kUnknown:
      memory.SetExtension(UnknownPage());
      break;
  }
  child_ = accessory;
  if (!motion_plus_active()) out.push_back(controller_.UnaskedStatus());
  return out;
}

std::vector<Report> Wiimote::Pull(std::int64_t now_ns) {
  std::vector<Report> out = Due(now_ns);
  Memory& memory = controller_.memory();
  if (!memory.has_motion_plus() || options_.motion_plus_inside) return PullBehind(now_ns);
  const bool said = memory.has_extension() || port_ready_ns_.has_value();
  memory.SetMotionPlus({});
  memory.SetExtension({});
  memory.set_port_ready(true);
  port_ready_ns_.reset();
  child_ = Accessory::kNone;
  if (said) out.push_back(controller_.UnaskedStatus());
  return out;
}

std::vector<Report> Wiimote::PullBehind(std::int64_t now_ns) {
  std::vector<Report> out = Due(now_ns);
  const bool said = child_ != Accessory::kNone && !motion_plus_active();
  child_ = Accessory::kNone;
  controller_.memory().SetExtension({});
  if (said) out.push_back(controller_.UnaskedStatus());
  return out;
}

std::vector<Report> Wiimote::Due(std::int64_t now_ns) {
  now_ns_ = std::max(now_ns_, now_ns);
  if (!port_ready_ns_ || now_ns_ < *port_ready_ns_) return {};
  port_ready_ns_.reset();
  controller_.memory().set_port_ready(true);
  if (!controller_.memory().has_extension()) return {};
  return {controller_.UnaskedStatus()};
}

std::vector<Report> Wiimote::HandleOutput(std::int64_t now_ns,
                                          std::span<const std::uint8_t> report) {
  std::vector<Report> out = Due(now_ns);
  Memory& memory = controller_.memory();
  const std::uint8_t before = memory.motion_plus_mode();
  std::vector<Report> answers = controller_.HandleOutput(report);
  out.insert(out.end(), answers.begin(), answers.end());
  if (memory.motion_plus_mode() == before) return out;
  memory.set_port_ready(false);
  port_ready_ns_ = now_ns_ + kDeadWindowNs;
  rubbish_ = memory.motion_plus_mode() != 0 ? 2 : 0;
  childs_turn_ = false;
  out.push_back(controller_.UnaskedStatus());
  return out;
}

std::vector<Report> Wiimote::Sample(std::int64_t now_ns, const WiimoteSensors& sensors) {
  std::vector<Report> out = Due(now_ns);
  if (controller_.mode() == 0) return out;
  Readings readings = Read(sensors);
  const ExtensionBytes packet = NextPacket(sensors);
  const bool nothing = std::all_of(packet.begin(), packet.end(), [](auto b) { return b == 0xff; });
  readings.extension.fill(nothing ? 0xff : 0);  // What is beyond the six bytes.
  std::copy(packet.begin(), packet.end(), readings.extension.begin());
  if (const auto report = controller_.DataReport(readings)) out.push_back(*report);
  return out;
}

std::optional<Report> Wiimote::Sample(const Eigen::Vector3d& specific_force_S_mps2,
                                      std::uint16_t buttons) {
  WiimoteSensors sensors;
  sensors.specific_force_S_mps2 = specific_force_S_mps2;
  sensors.buttons = buttons;
  const auto reports = Sample(now_ns_, sensors);
  if (reports.empty()) return std::nullopt;
  return reports.back();
}

Readings Wiimote::Read(const WiimoteSensors& sensors) const {
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
  return readings;
}

ExtensionBytes Wiimote::NextPacket(const WiimoteSensors& sensors) {
  constexpr ExtensionBytes kNothing = {0xff, 0xff, 0xff, 0xff, 0xff, 0xff};
  const Memory& memory = controller_.memory();
  if (!memory.port_ready()) return kNothing;
  const std::uint8_t mode = memory.motion_plus_mode();
  if (mode == 0) return memory.extension_plain() ? ChildPacket(sensors) : kNothing;
  if (rubbish_ > 0) {
    --rubbish_;
    return rubbish_ == 1 ? kNothing : ExtensionBytes{};
  }
  const bool passes =
      (mode == 5 && child_ == Accessory::kNunchuk) || (mode == 7 && child_ == Accessory::kClassic);
  childs_turn_ = passes && !childs_turn_;
  if (!childs_turn_) {
    return MotionPlusBytes(motion_plus_block_, sensors.angular_velocity_S_radps,
                           child_ != Accessory::kNone);
  }
  const ExtensionBytes plain = ChildPacket(sensors);
  return mode == 5 ? PassedNunchuk(plain) : PassedClassic(plain);
}

ExtensionBytes Wiimote::ChildPacket(const WiimoteSensors& sensors) {
  if (child_ == Accessory::kNunchuk) return NunchukBytes(nunchuk_block_, sensors.nunchuk);
  if (child_ == Accessory::kClassic) return ClassicBytes();
  if (child_ == Accessory::kUnknown) return {0x12, 0x34, 0x56, 0x78, 0x9a, 0xbc};
  return {0xff, 0xff, 0xff, 0xff, 0xff, 0xff};
}

}  // namespace footing::device_models
