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
  FOOTING_BYTES(stored_calibration);
}
FOOTING_BOTH_WAYS(DeviceStatus)

template <typename Way>
void Fields(Way way, const stream::RawReport&) {
  FOOTING_FIELD(device);
  FOOTING_FIELD(received_ns);
  FOOTING_BYTES(report);
  FOOTING_FIELD(to_device);
  FOOTING_FIELD(simulated);
  FOOTING_FIELD(true_ns);
  FOOTING_FIELD(feature);
}
FOOTING_BOTH_WAYS(RawReport)

}  // namespace footing::wire
