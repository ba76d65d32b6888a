#include "daemon/sensor/kinds/wiimote.h"

namespace footing::wiimote {

decode::Decoded Wiimote::Take(const reports::InputReport& report) {
  const handshake::ExtensionPort& port = sequencer_.port();
  const Setup setup = {
      sequencer_.acceleration(), port.nunchuk, sequencer_.motion_plus().calibration,
      port.ready() ? sequencer_.extension() : stream::Extension::kUnspecified, port.epoch()};
  return decoder_.Take(setup, report);
}

void Wiimote::AddTo(stream::DeviceStatus& status) const {
  status.calibration = sequencer_.acceleration_origin();
  status.extension_calibration = sequencer_.extension_origin();
  status.gyroscope_calibration = sequencer_.gyroscope_origin();
  status.extension_changes = sequencer_.port().changes();
  if (!sequencer_.status()) return;
  status.battery_low = sequencer_.status()->battery_low;
  status.battery_fraction = reports::BatteryFraction(sequencer_.status()->battery);
}

}  // namespace footing::wiimote
