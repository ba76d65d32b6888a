#include "common/wire/fields.h"

namespace footing::wire {

template <typename Way>
void Fields(Way way, const stream::DeviceStatus&) {
  FOOTING_FIELD(device);
  FOOTING_FIELD(serial);
  FOOTING_ENUM(DeviceKind, kind);
  FOOTING_ENUM(DeviceState, state);
  FOOTING_FIELD(rig);
  FOOTING_ENUM(DeviceRole, role);
  FOOTING_FIELD(simulated);
  FOOTING_ENUM(CalibrationOrigin, calibration);
  FOOTING_FIELD(report_rate_hz);
  FOOTING_FIELD(jitter_ms);
  FOOTING_FIELD(reports);
  FOOTING_FIELD(gaps);
  FOOTING_FIELD(repeats);
  FOOTING_FIELD(clipped);
  FOOTING_FIELD(undecodable);
  FOOTING_FIELD(battery_fraction);
  FOOTING_FIELD(battery_low);
  FOOTING_FIELD(leds);
  FOOTING_FIELD(rumble);
  FOOTING_FIELD(note);
  FOOTING_FIELD(name);
  FOOTING_FIELD(last_report_ns);
  FOOTING_ENUM(Extension, extension);
  FOOTING_ENUM(CalibrationOrigin, extension_calibration);
  FOOTING_ENUM(CalibrationOrigin, gyroscope_calibration);
  FOOTING_FIELD(driver);
  FOOTING_FIELD(place);
  FOOTING_FIELD(mode_reasserts);
  FOOTING_FIELD(queue_drops);
  FOOTING_FIELD(writes_failed);
  FOOTING_FIELD(extension_changes);
  FOOTING_FIELD(tared);
  FOOTING_FIELD(mounted);
  FOOTING_FIELD(slipped);
  FOOTING_FIELD(moved);
  FOOTING_FIELD(clock_offset_sd_ms);
  FOOTING_FIELD(sphere_rgb);
  FOOTING_FIELD(bus);
  FOOTING_FIELD(vendor);
  FOOTING_FIELD(product);
  if constexpr (Way::kOut) {
    const auto& stored = way.value.stored_calibration;
    way.message.set_stored_calibration(stored.data(), stored.size());
  } else {
    const std::string& stored = way.message.stored_calibration();
    way.value.stored_calibration.assign(stored.begin(), stored.end());
  }
}
FOOTING_BOTH_WAYS(DeviceStatus)

v1::RawReport ToProto(const stream::RawReport& value) {
  v1::RawReport message;
  message.set_device(value.device);
  message.set_received_ns(value.received_ns);
  message.set_report(value.report.data(), value.report.size());
  message.set_to_device(value.to_device);
  message.set_simulated(value.simulated);
  message.set_true_ns(value.true_ns);
  message.set_feature(value.feature);
  return message;
}

stream::RawReport FromProto(const v1::RawReport& message) {
  stream::RawReport value;
  value.device = message.device();
  value.received_ns = message.received_ns();
  value.report.assign(message.report().begin(), message.report().end());
  value.to_device = message.to_device();
  value.simulated = message.simulated();
  value.true_ns = message.true_ns();
  value.feature = message.feature();
  return value;
}

}  // namespace footing::wire
