#include "common/virtual/devices/joycon.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "common/virtual/devices/noise.h"

namespace footing::virtual_devices {
namespace {

constexpr std::size_t kReportBytes = 49;
constexpr std::int64_t kTimerNs = 5'000'000;
constexpr double kCountsPerG = 4096;
constexpr double kSpanDegps = 936;
constexpr double kForceNoiseCounts = 2.9, kTurnNoiseCounts = 1;  // As recorded at rest.

constexpr std::uint8_t kInfo = 0x02, kMode = 0x03, kRead = 0x10, kLamps = 0x30, kSensor = 0x40,
                       kVibration = 0x48;

struct Product {
  std::uint32_t product;
  const char* name;
  std::uint8_t type;
};
constexpr Product kProducts[] = {{stream::kProductJoyConLeft, "Joy-Con (L)", 1},
                                 {stream::kProductJoyConRight, "Joy-Con (R)", 2},
                                 {stream::kProductSwitchPro, "Pro Controller", 3}};

void Put12(int first, int second, std::uint8_t* at) {
  at[0] = static_cast<std::uint8_t>(first);
  at[1] = static_cast<std::uint8_t>((first >> 8 & 0x0f) | second << 4);
  at[2] = static_cast<std::uint8_t>(second >> 4);
}

void Append16(int value, std::vector<std::uint8_t>& bytes) {
  bytes.push_back(static_cast<std::uint8_t>(value));
  bytes.push_back(static_cast<std::uint8_t>(value >> 8));
}

int ToCounts(double counts) {
  return static_cast<int>(std::clamp(std::round(counts), -32768.0, 32767.0));
}

}  // namespace

Joycon::Joycon(std::uint64_t seed, JoyconModel model) : model_(model) {
  const Product& product = kProducts[static_cast<std::size_t>(model)];
  identity_.product = product.product;
  identity_.name = product.name;
  identity_.serial = MakeSerial(SerialOf::kJoycon, seed + 1'000'003 * product.type);
  noise::Random random(seed);
  const auto draw = [&random](double least, double most) {
    return static_cast<int>(std::round(random.Uniform(least, most)));
  };
  // The newer units' gyroscope has the other coefficient.
  turn_coefficient_ = random.Uniform() < 0.5 ? 13371 : 15335;
  std::vector<std::uint8_t> motion;
  for (int axis = 0; axis < 3; ++axis) Append16(draw(-400, 400), motion);  // Not to be subtracted.
  for (int axis = 0; axis < 3; ++axis) Append16(16384, motion);
  for (int& zero : turn_zero_) {
    zero = draw(-60, 60);
    Append16(zero, motion);
  }
  for (int axis = 0; axis < 3; ++axis) Append16(turn_coefficient_, motion);
  Write(0x6020, motion);
  for (auto& pair : stick_) pair = {draw(1200, 1500), draw(1200, 1500)};
  stick_[0] = {draw(1950, 2150), draw(1950, 2150)};
  std::array<std::uint8_t, 18> sticks;
  sticks.fill(0xff);
  const auto& [centre, below, above] = stick_;
  const bool right = model == JoyconModel::kRight;
  std::uint8_t* const at = sticks.data() + (right ? 9 : 0);
  const auto& first = right ? centre : above;
  const auto& second = right ? below : centre;
  const auto& third = right ? above : below;
  Put12(first[0], first[1], at);
  Put12(second[0], second[1], at + 3);
  Put12(third[0], third[1], at + 6);
  Write(0x603d, sticks);
}

void Joycon::Write(std::uint32_t address, std::span<const std::uint8_t> bytes) {
  for (const std::uint8_t byte : bytes) memory_[address++] = byte;
}

void Joycon::set_battery(std::uint8_t level, bool charging) {
  battery_ = static_cast<std::uint8_t>(level << 5 | (charging ? 0x10 : 0));
}

std::vector<Report> Joycon::HandleOutput(std::int64_t now_ns,
                                         std::span<const std::uint8_t> report) {
  constexpr std::size_t kRumbleAt = 2, kRumbleBytes = 8, kSubcommandAt = 10;
  constexpr std::uint8_t kNeutral[] = {0x00, 0x01, 0x40, 0x40, 0x00, 0x01, 0x40, 0x40};
  if (written_ns_) least_interval_ns_ = std::min(least_interval_ns_, now_ns - *written_ns_);
  written_ns_ = now_ns;
  if (report.size() < kRumbleAt + kRumbleBytes) return {};
  shaking_ = !std::equal(std::begin(kNeutral), std::end(kNeutral), report.begin() + kRumbleAt);
  if (report[0] != 0x01 || report.size() <= kSubcommandAt) return {};
  Report reply(kReportBytes, 0);
  reply[0] = 0x21;
  PutHead(now_ns, last_, reply);
  reply[13] = 0x80;
  reply[14] = report[kSubcommandAt];
  Execute(report.subspan(kSubcommandAt), reply);
  return {reply};
}

/// `report`: subcommand and arguments.
void Joycon::Execute(std::span<const std::uint8_t> report, Report& reply) {
  const std::uint8_t argument = report.size() > 1 ? report[1] : 0;
  switch (report[0]) {
    case kInfo: {
      reply[13] = 0x82;
      const std::uint8_t type = kProducts[static_cast<std::size_t>(model_)].type;
      const std::uint8_t info[] = {0x04, 0x07, type, 0x02};
      std::copy(std::begin(info), std::end(info), reply.begin() + 15);
      for (std::size_t i = 0; i < 6; ++i) {
        reply[19 + i] = static_cast<std::uint8_t>(
            std::strtoul(identity_.serial.substr(3 * i, 2).c_str(), nullptr, 16));
      }
      reply[25] = 0x03;
      reply[26] = 0x01;
      return;
    }
    case kRead: {
      constexpr std::size_t kMostBytes = 0x1d;
      const std::size_t size = report.size() > 5 ? report[5] : 0;
      if (size == 0 || size > kMostBytes) {
        reply[13] = 0x00;
        return;
      }
      reply[13] = 0x90;
      std::copy_n(report.begin() + 1, 5, reply.begin() + 15);
      const std::uint32_t address = static_cast<std::uint32_t>(report[1] | report[2] << 8);
      for (std::size_t i = 0; i < size; ++i) {
        const auto found = memory_.find(address + static_cast<std::uint32_t>(i));
        reply[20 + i] = found == memory_.end() ? 0xff : found->second;
      }
      return;
    }
    case kMode:
      mode_ = argument;
      return;
    case kLamps:
      leds_ = argument & 0x0f;
      return;
    case kSensor:
      sensor_mode_ = argument;
      return;
    case kVibration:
      vibration_ = argument != 0;
      return;
    default:
      return;
  }
}

/// Timer, battery, buttons and sticks.
void Joycon::PutHead(std::int64_t now_ns, const JoyconSensors& sensors, Report& report) const {
  report[1] = static_cast<std::uint8_t>(now_ns / kTimerNs);
  report[2] = static_cast<std::uint8_t>(battery_ | (model_ == JoyconModel::kPro ? 0x00 : 0x0e));
  for (std::size_t i = 0; i < 3; ++i) {
    report[3 + i] = static_cast<std::uint8_t>(sensors.buttons >> 8 * i);
  }
  const auto counts = [&](double share, std::size_t axis) {
    const int span = stick_[share < 0 ? 1 : 2][axis];
    return static_cast<int>(std::round(stick_[0][axis] + std::clamp(share, -1.0, 1.0) * span));
  };
  const std::size_t at = model_ == JoyconModel::kRight ? 9 : 6;
  Put12(counts(sensors.stick_x, 0), counts(sensors.stick_y, 1), report.data() + at);
}

/// Raw x points to the triggers, y left, z out of the buttons; of a right one y and z the other
/// way.
Eigen::Vector3d Joycon::Raw(const Eigen::Vector3d& of_S) const {
  const double sign = model_ == JoyconModel::kRight ? -1 : 1;
  return {of_S.y(), sign * of_S.x(), -sign * of_S.z()};
}

void Joycon::PutSample(const JoyconSensors& sensors, std::size_t at, Report& report) {
  const auto put = [&](std::size_t where, int value) {
    report[where] = static_cast<std::uint8_t>(value);
    report[where + 1] = static_cast<std::uint8_t>(value >> 8);
  };
  const Eigen::Vector3d force = Raw(sensors.specific_force_S_mps2);
  const Eigen::Vector3d turn = Raw(sensors.angular_velocity_S_radps);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    put(at + 2 * i, ToCounts(force[axis] / kStandardGravityMps2 * kCountsPerG));
    const double gain = (turn_coefficient_ - turn_zero_[i]) / DegreesToRadians(kSpanDegps);
    int counts = ToCounts(turn[axis] * gain + turn_zero_[i]);
    if (sensor_mode_ != 1) {
      attitude_ = attitude_ * 1664525u + 1013904223u;
      counts = static_cast<std::int16_t>(attitude_ >> 16);
    }
    put(at + 6 + 2 * i, counts);
  }
}

std::vector<Report> Joycon::Sample(std::int64_t now_ns, const JoyconBurst& burst) {
  const bool pressed = burst.back().buttons != last_.buttons;
  last_ = burst.back();
  if (mode_ < 0x30 || mode_ > 0x33) {
    if (!pressed) return {};
    Report simple(12, 0);
    simple[0] = 0x3f;
    return {simple};
  }
  Report report(kReportBytes, 0);
  report[0] = mode_;
  PutHead(now_ns, last_, report);
  if (sensor_mode_ != 0) {
    constexpr std::size_t kFirstAt = 13, kSampleBytes = 12;
    for (std::size_t i = 0; i < burst.size(); ++i) {
      PutSample(burst[burst.size() - 1 - i], kFirstAt + kSampleBytes * i, report);
    }
  }
  return {report};
}

JoyconSensors WithNoise(JoyconSensors sensors, noise::Random& random) {
  sensors.specific_force_S_mps2 +=
      noise::NormalVector(kForceNoiseCounts / kCountsPerG * kStandardGravityMps2, random);
  constexpr double kTurnCountRadps = DegreesToRadians(kSpanDegps) / 13371;
  sensors.angular_velocity_S_radps +=
      noise::NormalVector(kTurnNoiseCounts * kTurnCountRadps, random);
  return sensors;
}

}  // namespace footing::virtual_devices
