#include "common/virtual/devices/phone.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>

#include "common/stream/product_ids.h"

namespace footing::virtual_devices {
namespace {

constexpr double kStepMps2 = 0.1, kStepDegps = 0.1;  // As browsers round.
constexpr double kForceNoiseMps2 = 0.03, kTurnNoiseRadps = 0.003;
constexpr double kRangesG[] = {4, 8, 16};
constexpr double kMostDrift = 50e-6;
constexpr std::int64_t kMostAheadS = 1'000'000;
constexpr std::int64_t kTimeStepUs = 100;
constexpr std::uint8_t kInput = 1, kInverted = 1, kHasRate = 2, kDegrees = 4, kNoBattery = 255;

template <typename Value>
void Append(Value value, Report& report) {
  static_assert(std::endian::native == std::endian::little);
  std::uint8_t bytes[sizeof(value)];
  std::memcpy(bytes, &value, sizeof(value));
  report.insert(report.end(), std::begin(bytes), std::end(bytes));
}

/// In the axes of a browser: x to the right, y to the top, z out of the screen.
void AppendOfS(const Eigen::Vector3d& of_S, double step, Report& report) {
  for (const double value : {-of_S.x(), of_S.y(), -of_S.z()}) {
    Append(static_cast<float>(std::round(value / step) * step), report);
  }
}

}  // namespace

Phone::Phone(std::uint64_t seed) : random_(seed) {
  identity_.bus = 0;
  identity_.vendor = stream::kVendorFooting;
  identity_.product = stream::kProductInertial;
  identity_.name = "web page on a simulated phone";
  identity_.serial = "phone-" + std::to_string(seed);
  period_ns_ = 1e9 / random_.Uniform(50, 100);
  range_mps2_ = kRangesG[random_.Integer(0, 2)] * kStandardGravityMps2;
  inverted_ = random_.Uniform() < 0.5;
  clock_rate_ = 1 + random_.Uniform(-kMostDrift, kMostDrift);
  clock_ahead_ns_ = SecondsToNanoseconds(random_.Uniform(0, kMostAheadS));
}

void Phone::Hold(const PhoneSensors& sensors) {
  held_.specific_force_S_mps2 =
      (sensors.specific_force_S_mps2 + noise::NormalVector(kForceNoiseMps2, random_))
          .cwiseMin(range_mps2_)
          .cwiseMax(-range_mps2_);
  held_.angular_velocity_S_radps =
      sensors.angular_velocity_S_radps + noise::NormalVector(kTurnNoiseRadps, random_);
}

void Phone::Feel(std::int64_t now_ns, const PhoneSensors& sensors) {
  const auto now = static_cast<double>(now_ns), before = static_cast<double>(felt_ns_);
  if (felt_ns_ == 0) next_ns_ = now;
  for (; next_ns_ <= now; next_ns_ += period_ns_) {
    const double share = felt_ns_ == 0 || now == before ? 1 : (next_ns_ - before) / (now - before);
    const auto between = [share](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
      return Eigen::Vector3d(from + share * (to - from));
    };
    Hold({between(felt_.specific_force_S_mps2, sensors.specific_force_S_mps2),
          between(felt_.angular_velocity_S_radps, sensors.angular_velocity_S_radps)});
  }
  felt_ns_ = now_ns;
  felt_ = sensors;
}

Report Phone::Event(std::int64_t now_ns) {
  const double own_ns =
      static_cast<double>(now_ns) * clock_rate_ + static_cast<double>(clock_ahead_ns_);
  const auto own_us = static_cast<std::uint64_t>(own_ns / 1e3 / kTimeStepUs) * kTimeStepUs;
  Report report = {kInput,
                   static_cast<std::uint8_t>((inverted_ ? kInverted : 0) | kHasRate | kDegrees)};
  Append(std::uint8_t{0}, report);
  Append(kNoBattery, report);
  Append(number_++, report);
  Append(own_us, report);
  Append(std::uint8_t{1}, report);
  Append(std::uint32_t{0}, report);
  AppendOfS((inverted_ ? -1 : 1) * held_.specific_force_S_mps2, kStepMps2, report);
  AppendOfS(held_.angular_velocity_S_radps * 180 / kPi, kStepDegps, report);
  return report;
}

LinkConfig PhoneLink(LinkQuality quality, std::uint64_t seed) {
  LinkConfig config{quality, 60, 60, seed, true};
  config.least_turn_s = 0.05;
  config.most_turn_s = 0.3;
  return config;
}

}  // namespace footing::virtual_devices
