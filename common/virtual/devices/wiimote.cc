#include "common/virtual/devices/wiimote.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "common/base/units.h"
#include "common/virtual/devices/noise.h"

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

/// Packet of an active MotionPlus: its own and the child's in turn.
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

namespace {

constexpr std::array<double, 3> kMoveRawSigns = {-1, +1, -1};
constexpr std::array<double, 3> kMagneticSigns = {-1, -1, -1};
constexpr double kRpmToRadps = 2 * kPi / 60;
constexpr std::size_t kHeadBytes = 2;
constexpr std::size_t kCalibrationPieceBytes = 49;
/// Nobody wrote down what a step of the time stamp is; hosts use it to see that reports differ.
constexpr std::int64_t kTickNs = 10'000;

/// Where the blob has what (moveonpc wiki, "Calibration data"): vectors of three words each.
struct CalibrationLayout {
  std::size_t pieces;
  std::array<std::size_t, 3> up;    ///< The axis points up: +1 g.
  std::array<std::size_t, 3> down;  ///< It points down: -1 g.
  std::array<std::size_t, 3> turn;  ///< Turning about the axis.
  std::array<std::size_t, 3> back;  ///< The same backwards; ZCM2 only.
  std::size_t bias;
  double turn_rpm;
};
constexpr CalibrationLayout kZcm1 = {
    3, {0x16, 0x1c, 0x04}, {0x0a, 0x22, 0x10}, {0x46, 0x4e, 0x56}, {}, 0x2a, 80};
constexpr CalibrationLayout kZcm2 = {
    2, {0x02, 0x0e, 0x1a}, {0x08, 0x14, 0x20}, {0x30, 0x36, 0x3c}, {0x42, 0x48, 0x4e}, 0x26, 90};
constexpr std::size_t kZcm1SecondBias = 0x32;
constexpr std::size_t kZcm1BiasFactor = 0x6a;

const CalibrationLayout& CalibrationLayoutOf(MoveModel model) {
  return model == MoveModel::kZcm1 ? kZcm1 : kZcm2;
}

/// A ZCM1 counts from 0x8000, a ZCM2 has two's complement.
int Zero(MoveModel model) { return model == MoveModel::kZcm1 ? 0x8000 : 0; }

void PutWord(MoveModel model, std::span<std::uint8_t> bytes, std::size_t at, int count) {
  const int raw = std::clamp(count, -0x8000, 0x7fff) + Zero(model);
  bytes[at] = static_cast<std::uint8_t>(raw);
  bytes[at + 1] = static_cast<std::uint8_t>(raw >> 8);
}

int Word(MoveModel model, std::span<const std::uint8_t> bytes, std::size_t at) {
  const int raw = bytes[at] | bytes[at + 1] << 8;
  return model == MoveModel::kZcm1 ? raw - 0x8000 : static_cast<std::int16_t>(raw);
}

double BiasFactor(std::span<const std::uint8_t> blob, std::size_t axis) {
  float factor = 0;
  std::memcpy(&factor, blob.data() + kZcm1BiasFactor + 4 * axis, sizeof factor);
  return factor;
}

int Rounded(double value) { return static_cast<int>(std::lround(std::clamp(value, -4e4, 4e4))); }

MoveSensors Between(const MoveSensors& a, const MoveSensors& b) {
  MoveSensors middle = b;
  middle.specific_force_S_mps2 = (a.specific_force_S_mps2 + b.specific_force_S_mps2) / 2;
  middle.angular_velocity_S_radps = (a.angular_velocity_S_radps + b.angular_velocity_S_radps) / 2;
  middle.trigger = (a.trigger + b.trigger) / 2;
  return middle;
}

}  // namespace

std::vector<std::uint8_t> DrawMoveBlob(std::uint64_t seed, MoveModel model) {
  // Around real units: 4050 to 4480 counts a g, 5170 to 5700 (ZCM1) and 6600 to 6900 (ZCM2) at the
  // turn, a gyroscope's bias of some hundred (ZCM1) or a few counts.
  noise::Random random(seed);
  const CalibrationLayout& layout = CalibrationLayoutOf(model);
  const bool first = model == MoveModel::kZcm1;
  std::vector<std::uint8_t> blob(layout.pieces * (kCalibrationPieceBytes - kHeadBytes) + kHeadBytes,
                                 0);
  blob[0] = 0x10;
  const auto put = [&](std::size_t at, std::size_t axis, int count) {
    PutWord(model, blob, at + 2 * axis, count);
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int one_g = random.Integer(4060, 4470);
    const int zero = random.Integer(-150, 150);
    for (std::size_t other = 0; other < 3; ++other) {
      const bool own = other == axis;
      put(layout.up[other], axis, own ? zero + one_g : zero + random.Integer(-60, 60));
      put(layout.down[other], axis, own ? zero - one_g : zero + random.Integer(-60, 60));
    }
    const int bias = first ? random.Integer(-400, 400) : random.Integer(-10, 10);
    const int turn = first ? random.Integer(5170, 5700) : random.Integer(6600, 6900);
    const auto factor = static_cast<float>(random.Uniform(0.96, 1.02));
    put(layout.bias, axis, bias);
    if (first) {
      put(kZcm1SecondBias, axis, bias + random.Integer(-11, 11));
      std::memcpy(blob.data() + kZcm1BiasFactor + 4 * axis, &factor, sizeof factor);
    }
    for (std::size_t other = 0; other < 3; ++other) {
      put(layout.turn[other], axis, bias + (other == axis ? turn : random.Integer(-160, 160)));
      if (!first) put(layout.back[other], axis, bias - (other == axis ? turn : 0));
    }
  }
  return blob;
}

PsMove::PsMove(std::uint64_t seed, MoveModel model)
    : PsMove(seed, model, DrawMoveBlob(seed, model)) {}

PsMove::PsMove(std::uint64_t seed, MoveModel model, std::vector<std::uint8_t> blob)
    : model_(model), blob_(std::move(blob)) {
  const CalibrationLayout& layout = CalibrationLayoutOf(model);
  blob_.resize(layout.pieces * (kCalibrationPieceBytes - kHeadBytes) + kHeadBytes);
  for (std::size_t i = 0; i < 3; ++i) {
    const int up = Word(model, blob_, layout.up[i] + 2 * i);
    const int down = Word(model, blob_, layout.down[i] + 2 * i);
    force_zero_[i] = (up + down) / 2.0;
    force_gain_[i] = (up - down) / 2.0 / kStandardGravityMps2;
    const int turn = Word(model, blob_, layout.turn[i] + 2 * i);
    const int bias = Word(model, blob_, layout.bias + 2 * i);
    // A ZCM1 takes its bias off itself: it is there for the calibration's values only.
    turn_zero_[i] = model == MoveModel::kZcm1 ? 0 : bias;
    const double span = model == MoveModel::kZcm1
                            ? turn - bias * BiasFactor(blob_, i)
                            : (turn - Word(model, blob_, layout.back[i] + 2 * i)) / 2.0;
    turn_gain_[i] = span / (layout.turn_rpm * kRpmToRadps);
  }
  identity_.vendor = stream::kVendorSony;
  identity_.product = model == MoveModel::kZcm1 ? stream::kProductZcm1 : stream::kProductZcm2;
  identity_.name = "Motion Controller";
  identity_.serial = MakeSerial(SerialOf::kPsMove, seed);
}

std::vector<Report> PsMove::HandleOutput(std::int64_t now_ns,
                                         std::span<const std::uint8_t> report) {
  constexpr std::size_t kUsedBytes = 7;
  if (report.size() < kUsedBytes || (report[0] != 0x06 && report[0] != 0x02)) return {};
  lights_ = true;
  lights_ns_ = now_ns;
  sphere_rgb_ = std::uint32_t{report[2]} << 16 | std::uint32_t{report[3]} << 8 | report[4];
  rumble_ = report[6];
  return {};
}

std::optional<Report> PsMove::Feature(std::uint8_t id, std::size_t size) {
  Report report;
  if (id == 0x10) {
    const std::size_t pieces = CalibrationLayoutOf(model_).pieces;
    const std::size_t piece = std::exchange(next_piece_, (next_piece_ + 1) % pieces);
    const auto from =
        blob_.begin() +
        static_cast<std::ptrdiff_t>(piece * (kCalibrationPieceBytes - kHeadBytes) + kHeadBytes);
    report = {0x10, static_cast<std::uint8_t>(piece | (piece + 1 == pieces ? 0x80 : 0))};
    report.insert(report.end(), from, from + (kCalibrationPieceBytes - kHeadBytes));
  } else if (id == 0x04) {
    report.assign(16, 0);
    report[0] = id;
    for (std::size_t i = 0; i < 6; ++i) {
      const std::string digits = identity_.serial.substr(3 * (5 - i), 2);
      report[1 + i] = static_cast<std::uint8_t>(std::strtoul(digits.c_str(), nullptr, 16));
    }
  } else {
    return std::nullopt;
  }
  report.resize(std::min(size, report.size()));
  return report;
}

void PsMove::PutSample(const MoveSensors& sensors, std::size_t half, Report& report) const {
  report[0x05 + half] = static_cast<std::uint8_t>(
      std::lround(255 * std::clamp(FiniteOrZero(sensors.trigger), 0.0, 1.0)));
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    const double force = kMoveRawSigns[i] * FiniteOrZero(sensors.specific_force_S_mps2[axis]);
    const double turn = kMoveRawSigns[i] * FiniteOrZero(sensors.angular_velocity_S_radps[axis]);
    PutWord(model_, report, 0x0d + 6 * half + 2 * i,
            Rounded(force_zero_[i] + force * force_gain_[i]));
    PutWord(model_, report, 0x19 + 6 * half + 2 * i, Rounded(turn_zero_[i] + turn * turn_gain_[i]));
  }
}

std::vector<Report> PsMove::Sample(std::int64_t now_ns, const MoveSensors& sensors) {
  const bool first = model_ == MoveModel::kZcm1;
  Report report(first ? 49 : 44, 0);
  report[0] = 0x01;
  report[1] = static_cast<std::uint8_t>(sensors.buttons >> 8);
  report[2] = static_cast<std::uint8_t>(sensors.buttons);
  report[3] = static_cast<std::uint8_t>(sensors.buttons >> 16 & 1);
  report[4] = static_cast<std::uint8_t>((sensors.buttons >> 13 & 0xc0) | sequence_);
  sequence_ = (sequence_ + 1) & 0x0f;
  const auto ticks = static_cast<std::uint64_t>(now_ns / kTickNs);
  report[0x0b] = static_cast<std::uint8_t>(ticks >> 8);
  report[first ? 0x2b : 0x28] = static_cast<std::uint8_t>(ticks);
  report[0x0c] = battery_;
  PutSample(first && last_ ? Between(*last_, sensors) : sensors, 0, report);
  PutSample(sensors, 1, report);
  last_ = sensors;
  report[0x25] = static_cast<std::uint8_t>(sensors.temperature_raw >> 4);
  report[0x26] = static_cast<std::uint8_t>((sensors.temperature_raw & 0x0f) << 4);
  if (first) {
    int field[3];
    for (std::size_t i = 0; i < 3; ++i) {
      const double value = sensors.magnetic_field_S_counts[static_cast<Eigen::Index>(i)];
      field[i] = std::clamp(Rounded(kMagneticSigns[i] * FiniteOrZero(value)), -2048, 2047) & 0xfff;
    }
    report[0x26] = static_cast<std::uint8_t>(report[0x26] | field[0] >> 8);
    report[0x27] = static_cast<std::uint8_t>(field[0]);
    report[0x28] = static_cast<std::uint8_t>(field[1] >> 4);
    report[0x29] = static_cast<std::uint8_t>((field[1] & 0x0f) << 4 | field[2] >> 8);
    report[0x2a] = static_cast<std::uint8_t>(field[2]);
  }
  return {report};
}

}  // namespace footing::virtual_devices
