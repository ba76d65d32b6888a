#include "common/wire/scalar.h"
#include "common/wire/wire.h"

namespace footing::wire {
namespace {

/// The same number on the other side; the enum's zero for a number that its .proto does not know.
template <typename To, typename From>
To Known(From value, bool known) {
  return known ? static_cast<To>(static_cast<int>(value)) : static_cast<To>(0);
}

}  // namespace

v1::DeviceStatus ToProto(const stream::DeviceStatus& value) {
  v1::DeviceStatus message;
  message.set_device(value.device);
  message.set_serial(Utf8(value.serial));
  message.set_kind(static_cast<v1::DeviceKind>(value.kind));
  message.set_state(static_cast<v1::DeviceState>(value.state));
  message.set_rig(Utf8(value.rig));
  message.set_role(static_cast<v1::DeviceRole>(value.role));
  message.set_simulated(value.simulated);
  message.set_calibration(static_cast<v1::CalibrationOrigin>(value.calibration));
  message.set_report_rate_hz(Finite(value.report_rate_hz));
  message.set_jitter_ms(Finite(value.jitter_ms));
  message.set_reports(value.reports);
  message.set_gaps(value.gaps);
  message.set_repeats(value.repeats);
  message.set_clipped(value.clipped);
  message.set_undecodable(value.undecodable);
  message.set_battery_fraction(Finite(value.battery_fraction));
  message.set_battery_low(value.battery_low);
  message.set_leds(value.leds);
  message.set_rumble(value.rumble);
  message.set_note(Utf8(value.note));
  message.set_name(Utf8(value.name));
  message.set_last_report_ns(value.last_report_ns);
  message.set_extension(static_cast<v1::Extension>(value.extension));
  message.set_extension_calibration(
      static_cast<v1::CalibrationOrigin>(value.extension_calibration));
  message.set_gyroscope_calibration(
      static_cast<v1::CalibrationOrigin>(value.gyroscope_calibration));
  message.set_driver(Utf8(value.driver));
  message.set_place(Utf8(value.place));
  message.set_mode_reasserts(value.mode_reasserts);
  message.set_queue_drops(value.queue_drops);
  message.set_writes_failed(value.writes_failed);
  message.set_extension_changes(value.extension_changes);
  message.set_tared(value.tared);
  message.set_mounted(value.mounted);
  message.set_slipped(value.slipped);
  message.set_moved(value.moved);
  message.set_clock_offset_sd_ms(Finite(value.clock_offset_sd_ms));
  message.set_sphere_rgb(value.sphere_rgb);
  return message;
}

stream::DeviceStatus FromProto(const v1::DeviceStatus& message) {
  stream::DeviceStatus value;
  value.device = message.device();
  value.serial = message.serial();
  value.kind = Known<stream::DeviceKind>(message.kind(), v1::DeviceKind_IsValid(message.kind()));
  value.state =
      Known<stream::DeviceState>(message.state(), v1::DeviceState_IsValid(message.state()));
  value.rig = message.rig();
  value.role = Known<stream::DeviceRole>(message.role(), v1::DeviceRole_IsValid(message.role()));
  value.simulated = message.simulated();
  value.calibration = Known<stream::CalibrationOrigin>(
      message.calibration(), v1::CalibrationOrigin_IsValid(message.calibration()));
  value.report_rate_hz = Finite(message.report_rate_hz());
  value.jitter_ms = Finite(message.jitter_ms());
  value.reports = message.reports();
  value.gaps = message.gaps();
  value.repeats = message.repeats();
  value.clipped = message.clipped();
  value.undecodable = message.undecodable();
  value.battery_fraction = Finite(message.battery_fraction());
  value.battery_low = message.battery_low();
  value.leds = message.leds();
  value.rumble = message.rumble();
  value.note = message.note();
  value.name = message.name();
  value.last_report_ns = message.last_report_ns();
  value.extension =
      Known<stream::Extension>(message.extension(), v1::Extension_IsValid(message.extension()));
  value.extension_calibration = Known<stream::CalibrationOrigin>(
      message.extension_calibration(),
      v1::CalibrationOrigin_IsValid(message.extension_calibration()));
  value.gyroscope_calibration = Known<stream::CalibrationOrigin>(
      message.gyroscope_calibration(),
      v1::CalibrationOrigin_IsValid(message.gyroscope_calibration()));
  value.driver = message.driver();
  value.place = message.place();
  value.mode_reasserts = message.mode_reasserts();
  value.queue_drops = message.queue_drops();
  value.writes_failed = message.writes_failed();
  value.extension_changes = message.extension_changes();
  value.tared = message.tared();
  value.mounted = message.mounted();
  value.slipped = message.slipped();
  value.moved = message.moved();
  value.clock_offset_sd_ms = Finite(message.clock_offset_sd_ms());
  value.sphere_rgb = message.sphere_rgb();
  return value;
}

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
