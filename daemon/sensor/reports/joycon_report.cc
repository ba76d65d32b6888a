#include "daemon/sensor/reports/joycon_report.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::reports {
namespace {

constexpr std::size_t kHeadBytes = 13;  // Up to the vibrator's byte.
constexpr std::size_t kReplyAt = 13;
constexpr std::size_t kRumbleAt = 2;
constexpr std::array<std::uint8_t, 4> kNeutral = {0x00, 0x01, 0x40, 0x40};
// 320 and 160 Hz at some 60 % of their amplitudes.
constexpr std::array<std::uint8_t, 4> kShaking = {0x00, 0x81, 0x40, 0x60};

std::int16_t Int16(Bytes bytes, std::size_t at) {
  return static_cast<std::int16_t>(bytes[at] | bytes[at + 1] << 8);
}

JoyconStick Stick(Bytes bytes, std::size_t at) {
  return {static_cast<std::uint16_t>(bytes[at] | (bytes[at + 1] & 0x0f) << 8),
          static_cast<std::uint16_t>(bytes[at + 1] >> 4 | bytes[at + 2] << 4)};
}

JoyconSample Sample(Bytes bytes, std::size_t at) {
  JoyconSample sample;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sample.acceleration[axis] = Int16(bytes, at + 2 * axis);
    sample.angular_velocity[axis] = Int16(bytes, at + 6 + 2 * axis);
  }
  return sample;
}

}  // namespace

std::optional<JoyconReport> DecodeJoycon(Bytes bytes) {
  if (bytes.empty()) return std::nullopt;
  JoyconReport report;
  report.id = bytes[0];
  if (report.id == kJoyconSimple) return report;
  const bool motion = report.id >= kJoyconMotion && report.id <= kJoyconMotion + 3;
  if (!motion && report.id != kJoyconReplyId) return std::nullopt;
  if (bytes.size() < kJoyconReportBytes) return std::nullopt;
  report.timer = bytes[1];
  report.battery = std::min(bytes[2] >> 5, 4);
  report.charging = (bytes[2] & 0x10) != 0;
  report.buttons = static_cast<std::uint32_t>(bytes[3] | bytes[4] << 8 | bytes[5] << 16);
  report.sticks = {Stick(bytes, 6), Stick(bytes, 9)};
  if (motion) {
    constexpr std::size_t kSampleBytes = 12;
    report.has_samples = true;
    for (std::size_t i = 0; i < 3; ++i) {
      report.samples[2 - i] = Sample(bytes, kHeadBytes + kSampleBytes * i);  // Newest first.
    }
    return report;
  }
  JoyconReply& reply = report.reply.emplace();
  reply.acknowledged = (bytes[kReplyAt] & 0x80) != 0;
  reply.subcommand = bytes[kReplyAt + 1];
  std::copy_n(bytes.begin() + kReplyAt + 2, reply.data.size(), reply.data.begin());
  return report;
}

OutputReport JoyconCommand(Subcommand subcommand, std::span<const std::uint8_t> arguments) {
  OutputReport report = JoyconRumbleOnly();
  report[0] = kJoyconCommand;
  report.push_back(static_cast<std::uint8_t>(subcommand));
  report.insert(report.end(), arguments.begin(), arguments.end());
  report.resize(kJoyconReportBytes, 0);
  return report;
}

OutputReport JoyconRead(std::uint32_t address, std::uint8_t size) {
  const std::uint8_t arguments[] = {
      static_cast<std::uint8_t>(address), static_cast<std::uint8_t>(address >> 8),
      static_cast<std::uint8_t>(address >> 16), static_cast<std::uint8_t>(address >> 24), size};
  return JoyconCommand(Subcommand::kReadMemory, arguments);
}

OutputReport JoyconRumbleOnly() {
  OutputReport report(kRumbleAt + 2 * kNeutral.size(), 0);
  report[0] = kJoyconRumble;
  SetJoyconRumble(report, false);
  return report;
}

void SetJoyconRumble(OutputReport& report, bool on) {
  const auto& motor = on ? kShaking : kNeutral;
  if (report.size() < kRumbleAt + 2 * motor.size()) return;
  for (const std::size_t at : {kRumbleAt, kRumbleAt + motor.size()}) {
    std::copy(motor.begin(), motor.end(), report.begin() + static_cast<std::ptrdiff_t>(at));
  }
}

std::span<const std::uint8_t> BlockIn(const JoyconReply& reply, const JoyconBlock& block) {
  constexpr std::size_t kAddressBytes = 5;
  const auto& data = reply.data;
  const std::uint32_t address = static_cast<std::uint32_t>(data[0] | data[1] << 8 | data[2] << 16) |
                                static_cast<std::uint32_t>(data[3]) << 24;
  if (reply.subcommand != static_cast<std::uint8_t>(Subcommand::kReadMemory) ||
      address != block.address || data[4] != block.size ||
      kAddressBytes + block.size > data.size()) {
    return {};
  }
  return std::span(data).subspan(kAddressBytes, block.size);
}

namespace {

constexpr std::int64_t kMayWrapNs = 600'000'000;
constexpr std::int64_t kJudgedNs = 1'000'000'000;
constexpr double kLeastShare = 0.7, kMostShare = 1.4;

}  // namespace

std::optional<std::int64_t> JoyconTimer::Advance(std::int64_t received_ns, std::uint8_t count) {
  const std::int64_t pause_ns = received_ns - received_ns_;
  const auto counts = static_cast<std::uint8_t>(count - count_);
  const bool goes_on = started_ && pause_ns >= 0 && pause_ns < kMayWrapNs;
  started_ = true;
  count_ = count;
  received_ns_ = received_ns;
  if (!goes_on) {
    window_ns_ = window_counts_ = 0;
    return std::nullopt;
  }
  own_ns_ += counts * kJoyconTickNs;
  window_ns_ += pause_ns;
  window_counts_ += counts;
  if (window_ns_ >= kJudgedNs) {
    const double share =
        static_cast<double>(window_counts_ * kJoyconTickNs) / static_cast<double>(window_ns_);
    trusted_ = share > kLeastShare && share < kMostShare;
    window_ns_ = window_counts_ = 0;
  }
  if (!trusted_) return std::nullopt;
  return own_ns_;
}

}  // namespace footing::reports

namespace footing::calibration {
namespace {

using reports::JoyconModel;
using Block = std::span<const std::uint8_t>;

constexpr double kCountsPerG = 4096;
constexpr double kGyroscopeSpanRadps = DegreesToRadians(936);  // hid-nintendo, SDL.
constexpr int kTypicalCoefficient = 13371;
constexpr int kJoyconTopCount = 32767;
// Real units: coefficients 13371, 15335 and 16384; offsets up to 430.
constexpr int kLeastCoefficient = 8000, kMostCoefficient = 24000, kMostOffset = 1500;
constexpr std::size_t kMotionBytes = 24, kMarkBytes = 2, kStickBytes = 9;

int Count(Block block, std::size_t at) {
  return static_cast<std::int16_t>(block[at] | block[at + 1] << 8);
}

bool HasMark(Block block) { return block.size() > 2 && block[0] == 0xb2 && block[1] == 0xa1; }

/// Offsets and coefficients of the accelerometer, then of the gyroscope, three each.
std::string WhyNot(Block block) {
  if (block.empty()) return "not answered";
  if (block.size() < kMotionBytes) return "cut short";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const std::size_t offset_at : {std::size_t{0}, std::size_t{12}}) {
      const int coefficient = Count(block, offset_at + 6 + 2 * axis);
      if (std::abs(Count(block, offset_at + 2 * axis)) >= kMostOffset) return "impossible offset";
      if (coefficient < kLeastCoefficient || coefficient > kMostCoefficient) {
        return "impossible coefficient";
      }
    }
  }
  return "";
}

void TakeMotion(Block block, JoyconCalibration& calibration) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int offset = Count(block, 12 + 2 * axis), coefficient = Count(block, 18 + 2 * axis);
    calibration.gyroscope_zero_counts[axis] = offset;
    calibration.gyroscope_gain_radps[axis] = kGyroscopeSpanRadps / (coefficient - offset);
  }
}

/// Three pairs of 12 bits: left stick ends above, centre, ends below; right centre, below, above.
std::optional<std::array<JoyconStickAxis, 2>> ParseStick(Block block, bool left) {
  std::array<std::array<double, 2>, 3> pairs{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t at = 3 * i;
    pairs[i] = {static_cast<double>(block[at] | (block[at + 1] & 0x0f) << 8),
                static_cast<double>(block[at + 1] >> 4 | block[at + 2] << 4)};
  }
  const auto& centre = pairs[left ? 1 : 0];
  const auto& below = pairs[left ? 2 : 1];
  const auto& above = pairs[left ? 0 : 2];
  std::array<JoyconStickAxis, 2> axes;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    constexpr double kLeastSpan = 200, kLeastCentre = 1000, kMostCentre = 3100, kTop = 4095;
    axes[axis] = {centre[axis], below[axis], above[axis]};
    const JoyconStickAxis& one = axes[axis];
    // Unset memory is FFF everywhere.
    if (one.centre < kLeastCentre || one.centre > kMostCentre || one.below < kLeastSpan ||
        one.above < kLeastSpan || one.centre - one.below < 0 || one.centre + one.above > kTop) {
      return std::nullopt;
    }
  }
  return axes;
}

void TakeSticks(const JoyconBlocks& blocks, JoyconCalibration& calibration) {
  constexpr std::size_t kUserBytes = kMarkBytes + kStickBytes;
  for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
    const Block factory = blocks.factory_sticks, user = blocks.user_sticks;
    std::optional<std::array<JoyconStickAxis, 2>> axes;
    if (user.size() >= 2 * kUserBytes && HasMark(user.subspan(side * kUserBytes))) {
      axes = ParseStick(user.subspan(side * kUserBytes + kMarkBytes, kStickBytes), side == 0);
    }
    if (!axes && factory.size() >= 2 * kStickBytes) {
      axes = ParseStick(factory.subspan(side * kStickBytes, kStickBytes), side == 0);
    }
    if (!axes) continue;
    calibration.sticks[side] = *axes;
    calibration.stick_known[side] = true;
  }
}

/// From raw axes to S, and the bits of raw axes to those of S.
Eigen::Vector3d ToS(JoyconModel model, const Eigen::Vector3d& raw) {
  const double sign = model == JoyconModel::kRight ? -1 : 1;
  return {sign * raw.y(), raw.x(), -sign * raw.z()};
}

}  // namespace

JoyconCalibration ParseJoycon(const JoyconBlocks& blocks) {
  JoyconCalibration calibration;
  calibration.gyroscope_gain_radps.fill(kGyroscopeSpanRadps / kTypicalCoefficient);
  TakeSticks(blocks, calibration);
  const bool marked = HasMark(blocks.user_motion);
  const Block user = marked ? Block(blocks.user_motion).subspan(kMarkBytes) : Block();
  const std::string factory_problem = WhyNot(blocks.factory_motion);
  if (marked && WhyNot(user).empty()) {
    calibration.origin = stream::CalibrationOrigin::kDevice;
    TakeMotion(user, calibration);
  } else if (factory_problem.empty()) {
    calibration.origin =
        marked ? stream::CalibrationOrigin::kDeviceCopy : stream::CalibrationOrigin::kDevice;
    TakeMotion(blocks.factory_motion, calibration);
  } else {
    calibration.problem =
        "calibration of its motion sensor: " + factory_problem + "; typical values are used";
  }
  return calibration;
}

JoyconReading Calibrate(const JoyconCalibration& calibration, JoyconModel model,
                        const reports::JoyconSample& sample) {
  Eigen::Vector3d force, turn, clipped;
  JoyconReading reading;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    force[axis] = sample.acceleration[i] / kCountsPerG * kStandardGravityMps2;
    turn[axis] = (sample.angular_velocity[i] - calibration.gyroscope_zero_counts[i]) *
                 calibration.gyroscope_gain_radps[i];
    clipped[axis] = std::abs(int{sample.acceleration[i]}) >= kJoyconTopCount ? 1 : 0;
    if (std::abs(int{sample.angular_velocity[i]}) >= kJoyconTopCount) {
      reading.angular_velocity_clipped = true;
    }
  }
  reading.specific_force_S_mps2 = ToS(model, force);
  reading.angular_velocity_S_radps = ToS(model, turn);
  const Eigen::Vector3d clipped_S = ToS(model, clipped);
  for (int axis = 0; axis < 3; ++axis) {
    if (clipped_S[axis] != 0) reading.clipped_axes |= 1u << axis;
  }
  return reading;
}

Eigen::Vector2d StickOf(const std::array<JoyconStickAxis, 2>& axes,
                        const reports::JoyconStick& stick) {
  const std::array<double, 2> counts = {static_cast<double>(stick.x), static_cast<double>(stick.y)};
  Eigen::Vector2d position;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double off = counts[axis] - axes[axis].centre;
    const double share = off / (off < 0 ? axes[axis].below : axes[axis].above);
    position[static_cast<Eigen::Index>(axis)] = std::clamp(share, -1.0, 1.0);
  }
  return position;
}

}  // namespace footing::calibration
