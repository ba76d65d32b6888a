#include "daemon/sensor/kinds/ps_move_decoder.h"

namespace footing::ps_move {
namespace {

bool SameReading(const reports::MoveSample& a, const reports::MoveSample& b) {
  return a.acceleration == b.acceleration && a.angular_velocity == b.angular_velocity &&
         a.trigger == b.trigger;
}

}  // namespace

std::optional<decode::Decoded> Decoder::Take(const calibration::MoveCalibration& calibration,
                                             reports::Bytes bytes) {
  const auto report = reports::DecodeMove(model_, bytes);
  if (!report) return std::nullopt;
  decode::Decoded decoded;
  decoded.motion_count = report->sample_count;
  for (std::size_t half = 0; half < report->sample_count; ++half) {
    const calibration::MoveReading reading = calibration::Calibrate(calibration, *report, half);
    stream::MotionSample& sample = decoded.motion[half];
    sample.specific_force_mps2 = reading.specific_force_S_mps2;
    sample.clipped_axes = reading.clipped_axes;
    sample.has_angular_velocity = true;
    sample.angular_velocity_radps = reading.angular_velocity_S_radps;
    sample.angular_velocity_clipped = reading.angular_velocity_clipped;
    sample.trigger = reading.trigger;
    sample.buttons = report->buttons;
    sample.uncalibrated = calibration.origin == stream::CalibrationOrigin::kDefaults;
    sample.gyroscope_uncalibrated = sample.uncalibrated;
    sample.has_magnetic_field = report->has_magnetic_field;
    sample.magnetic_field = calibration::MagneticField(*report);
    sample.temperature_c = reports::MoveTemperature(report->temperature);
    const bool same = last_ && SameReading(*last_, report->samples[half]);
    sample.repeated = same && report->buttons == last_buttons_;
    decoded.changed = decoded.changed || !same;
    last_ = report->samples[half];
    last_buttons_ = report->buttons;
  }
  battery_fraction_ = reports::MoveBatteryFraction(report->battery);
  return decoded;
}

}  // namespace footing::ps_move
