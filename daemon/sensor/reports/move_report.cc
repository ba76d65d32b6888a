#include "daemon/sensor/reports/move_report.h"

#include <algorithm>

namespace footing::reports {
namespace {

constexpr std::size_t kButtonsAt = 0x01;
constexpr std::size_t kTriggerAt = 0x05;
constexpr std::size_t kTimeHighAt = 0x0b;
constexpr std::size_t kBatteryAt = 0x0c;
constexpr std::size_t kAccelerationAt = 0x0d;
constexpr std::size_t kAngularVelocityAt = 0x19;
constexpr std::size_t kSampleBytes = 6;
constexpr std::size_t kTemperatureAt = 0x25;
constexpr std::size_t kMagneticFieldAt = 0x26;

std::size_t TimeLowAt(MoveModel model) { return model == MoveModel::kZcm1 ? 0x2b : 0x28; }

/// 16 bits, low byte first; a ZCM1 counts from 0x8000, a ZCM2 has two's complement.
std::array<std::int16_t, 3> Vector(MoveModel model, Bytes report, std::size_t at) {
  const int zero = model == MoveModel::kZcm1 ? 0x8000 : 0;
  std::array<std::int16_t, 3> vector{};
  for (std::size_t i = 0; i < 3; ++i) {
    vector[i] = static_cast<std::int16_t>((report[at + 2 * i] | report[at + 2 * i + 1] << 8) - zero);
  }
  return vector;
}

std::int16_t Signed12(int value) {
  return static_cast<std::int16_t>(value >= 0x800 ? value - 0x1000 : value);
}

std::uint32_t Buttons(Bytes b) {
  return std::uint32_t{b[1]} | std::uint32_t{b[0]} << 8 | (b[2] & 0x01u) << 16 |
         (b[3] & 0xc0u) << 13;
}

}  // namespace

std::optional<MoveReport> DecodeMove(MoveModel model, Bytes report) {
  if (report.size() <= TimeLowAt(model) || report[0] != kMoveInput) return std::nullopt;
  MoveReport out;
  out.buttons = Buttons(report.subspan(kButtonsAt, 4));
  out.sequence = report[kButtonsAt + 3] & 0x0f;
  out.timestamp =
      static_cast<std::uint16_t>(report[kTimeHighAt] << 8 | report[TimeLowAt(model)]);
  out.battery = report[kBatteryAt];
  out.sample_count = model == MoveModel::kZcm1 ? 2 : 1;
  for (std::size_t i = 0; i < out.sample_count; ++i) {
    MoveSample& sample = out.samples[i];
    sample.acceleration = Vector(model, report, kAccelerationAt + i * kSampleBytes);
    sample.angular_velocity = Vector(model, report, kAngularVelocityAt + i * kSampleBytes);
    sample.trigger = report[kTriggerAt + i];
  }
  out.temperature =
      static_cast<std::uint16_t>(report[kTemperatureAt] << 4 | report[kTemperatureAt + 1] >> 4);
  if (model == MoveModel::kZcm1) {
    const Bytes m = report.subspan(kMagneticFieldAt, 5);
    out.has_magnetic_field = true;
    out.magnetic_field = {Signed12((m[0] & 0x0f) << 8 | m[1]), Signed12(m[2] << 4 | m[3] >> 4),
                          Signed12((m[3] & 0x0f) << 8 | m[4])};
  }
  return out;
}

double MoveBatteryFraction(std::uint8_t raw) {
  constexpr std::uint8_t kFullAtCharger = 0xef;
  if (raw <= 5) return raw / 5.0;
  return raw == kFullAtCharger ? 1 : -1;
}

double MoveTemperature(std::uint16_t raw) {
  struct Point {
    double raw;
    double celsius;
  };
  constexpr Point kPoints[] = {{502, -10}, {811, 0},   {1208, 10}, {1664, 20}, {2131, 30},
                               {2560, 40}, {2925, 50}, {3215, 60}, {3418, 69}};
  if (raw <= kPoints[0].raw) return kPoints[0].celsius;
  for (std::size_t i = 1; i < std::size(kPoints); ++i) {
    const Point& low = kPoints[i - 1];
    const Point& high = kPoints[i];
    if (raw <= high.raw) {
      return low.celsius +
             (high.celsius - low.celsius) * (raw - low.raw) / (high.raw - low.raw);
    }
  }
  return std::rbegin(kPoints)->celsius;
}

OutputReport MoveLights(std::uint32_t rgb, std::uint8_t rumble) {
  return {kMoveLights,
          0,
          static_cast<std::uint8_t>(rgb >> 16),
          static_cast<std::uint8_t>(rgb >> 8),
          static_cast<std::uint8_t>(rgb),
          0,
          rumble,
          0,
          0};
}

}  // namespace footing::reports
