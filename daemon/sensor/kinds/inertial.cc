#include "daemon/sensor/kinds/inertial.h"

#include <algorithm>

#include "common/stream/product_ids.h"

namespace footing::inertial {
namespace {

constexpr double kLowBattery = 0.15;
/// A vibration is asked for again, since a page lets it end by itself.
constexpr std::int64_t kRepeatNs = 400'000'000;

}  // namespace

bool InertialSensor::Matches(const decode::Product& product) {
  return stream::IsInertialSensor(product.vendor, product.product);
}

void InertialSensor::Restart() {
  last_.reset();
  number_.reset();
  lost_ = 0;
  range_end_ = {};
}

std::optional<decode::Decoded> InertialSensor::Take(std::int64_t /*received_ns*/,
                                                    reports::Bytes bytes, kinds::Outputs&) {
  const auto report = reports::DecodeInertial(bytes);
  if (!report) return std::nullopt;
  if (number_) lost_ += static_cast<std::uint16_t>(report->number - *number_ - 1);
  number_ = report->number;
  battery_fraction_ = report->battery_fraction;
  decode::Decoded decoded;
  decoded.own_times = true;
  for (std::size_t i = 0; i < report->count; ++i) {
    const reports::InertialSample& measured = report->samples[i];
    stream::MotionSample& sample = decoded.motion.emplace_back();
    sample.sampled_ns = measured.device_ns;
    sample.specific_force_mps2 = measured.specific_force_S_mps2;
    sample.clipped_axes = report->knows_end ? measured.clipped_axes
                                            : range_end_.AxesAt(measured.specific_force_S_mps2);
    sample.has_angular_velocity = report->has_rate;
    sample.angular_velocity_radps = measured.angular_velocity_S_radps;
    sample.buttons = report->buttons;
    sample.repeated = last_ && last_->specific_force_S_mps2 == measured.specific_force_S_mps2 &&
                      last_->angular_velocity_S_radps == measured.angular_velocity_S_radps;
    decoded.changed = decoded.changed || !sample.repeated;
    last_ = measured;
  }
  return decoded;
}

std::optional<reports::OutputReport> InertialSensor::NextOutput(std::int64_t now_ns,
                                                                link::Outbox& outbox) {
  const bool on = outbox.rumble();
  if (on == vibrates_ && !(on && now_ns - sent_ns_ >= kRepeatNs)) return std::nullopt;
  vibrates_ = on;
  sent_ns_ = now_ns;
  return reports::OutputReport{reports::kInertialVibrate, static_cast<std::uint8_t>(on ? 1 : 0)};
}

reports::OutputReport InertialSensor::MotorOff() const { return {reports::kInertialVibrate, 0}; }

void InertialSensor::AddTo(stream::DeviceStatus& status) const {
  Kind::AddTo(status);
  // Its samples come in SI units, by the calibration of whoever made it.
  status.calibration = status.gyroscope_calibration = stream::CalibrationOrigin::kDevice;
  status.battery_fraction = battery_fraction_;
  status.battery_low = battery_fraction_ >= 0 && battery_fraction_ < kLowBattery;
  status.extension = stream::Extension::kNone;
}

std::string InertialSensor::Note(std::int64_t) const {
  return lost_ == 0 ? "" : std::to_string(lost_) + " of its reports were lost on the way";
}

}  // namespace footing::inertial
