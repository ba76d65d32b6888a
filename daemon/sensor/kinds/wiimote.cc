#include "daemon/sensor/kinds/wiimote.h"

#include "daemon/sensor/kinds/decoded.h"
#include "daemon/sensor/reports/input_report.h"

namespace footing::wiimote {
namespace {

using decode::Decoded;
using reports::MotionPlusCounts;
using reports::NunchukCounts;
using stream::CalibrationOrigin;
using stream::Extension;

constexpr int kFirstPackets = 2;

bool IsMotionPlus(Extension extension) {
  return extension == Extension::kMotionPlus || extension == Extension::kMotionPlusNunchuk ||
         extension == Extension::kMotionPlusClassic;
}

bool Same(const NunchukCounts& a, const NunchukCounts& b) {
  return a.stick_x == b.stick_x && a.stick_y == b.stick_y && a.acceleration == b.acceleration &&
         a.c == b.c && a.z == b.z;
}

bool Same(const MotionPlusCounts& a, const MotionPlusCounts& b) {
  return a.counts == b.counts && a.slow == b.slow;
}

}  // namespace

Decoded Decoder::Take(const Setup& setup, const reports::InputReport& report) {
  const auto* body = std::get_if<reports::Data>(&report.body);
  const auto data = body == nullptr ? std::nullopt : interleaver_.Take(*body);
  if (!data || !data->has_acceleration) {
    return report.has_buttons ? TakeButtons(report.buttons) : Decoded();
  }
  const calibration::Acceleration acceleration =
      calibration::Calibrate(setup.acceleration, data->acceleration_counts);
  Decoded decoded;
  stream::MotionSample& sample = decoded.motion.emplace_back();
  sample.specific_force_mps2 = acceleration.specific_force_S_mps2;
  sample.clipped_axes = acceleration.clipped_axes;
  sample.buttons = report.has_buttons ? report.buttons : last_.buttons;
  sample.uncalibrated = setup.acceleration.origin == CalibrationOrigin::kDefaults;
  const bool same_counts = has_last_ && data->acceleration_counts == last_counts_;
  sample.repeated = same_counts && sample.buttons == last_.buttons;
  decoded.changed = !same_counts;
  if (!data->extension().empty()) TakeExtension(setup, data->extension(), decoded);
  if (!data->camera().empty()) {
    decoded.camera.emplace();
    decoded.camera->points = reports::DecodeCamera(data->camera());
  }
  has_last_ = true;
  last_counts_ = data->acceleration_counts;
  last_ = sample;
  return decoded;
}

void Decoder::TakeExtension(const Setup& setup, reports::Bytes bytes, Decoded& decoded) {
  if (setup.extension_epoch != extension_epoch_) {
    extension_epoch_ = setup.extension_epoch;
    packets_to_drop_ = IsMotionPlus(setup.extension) ? kFirstPackets : 0;
    last_gyroscope_.reset();
    last_nunchuk_.reset();
    last_gamepad_.reset();
  }
  if (setup.extension == Extension::kNunchuk) {
    if (const auto counts = reports::DecodeNunchuk(bytes)) TakeNunchuk(setup, *counts, decoded);
    return;
  }
  if (setup.extension == Extension::kClassic) {
    TakeClassic(reports::DecodeClassic(bytes), decoded);
    return;
  }
  if (!IsMotionPlus(setup.extension)) return;
  const reports::PassedPacket packet = reports::PacketOf(bytes);
  if (packets_to_drop_ > 0) {
    --packets_to_drop_;
    return;
  }
  if (packet == reports::PassedPacket::kExtension &&
      setup.extension == Extension::kMotionPlusNunchuk) {
    if (const auto counts = reports::DecodePassedNunchuk(bytes)) {
      TakeNunchuk(setup, *counts, decoded);
    }
  }
  if (packet == reports::PassedPacket::kExtension &&
      setup.extension == Extension::kMotionPlusClassic) {
    TakeClassic(reports::DecodePassedClassic(bytes), decoded);
  }
  const auto counts = reports::DecodeMotionPlus(bytes);
  if (!counts) return;
  const auto reading = calibration::Calibrate(setup.motion_plus, *counts);
  stream::MotionSample& sample = decoded.motion[0];
  sample.has_angular_velocity = true;
  sample.angular_velocity_radps = reading.angular_velocity_S_radps;
  sample.angular_velocity_clipped = reading.clipped;
  sample.gyroscope_uncalibrated = setup.motion_plus.origin == CalibrationOrigin::kDefaults;
  const bool same = last_gyroscope_ && Same(*last_gyroscope_, *counts);
  sample.repeated = sample.repeated && same;
  last_gyroscope_ = counts;
}

void Decoder::TakeNunchuk(const Setup& setup, const NunchukCounts& counts, Decoded& decoded) {
  const auto reading = calibration::Calibrate(setup.nunchuk, counts);
  stream::NunchukSample& sample = decoded.nunchuk.emplace();
  sample.stick_x = reading.stick_x;
  sample.stick_y = reading.stick_y;
  sample.c = counts.c;
  sample.z = counts.z;
  sample.specific_force_mps2 = reading.specific_force_S_mps2;
  sample.clipped_axes = reading.clipped_axes;
  sample.repeated = last_nunchuk_ && Same(*last_nunchuk_, counts);
  sample.uncalibrated = setup.nunchuk.origin == CalibrationOrigin::kDefaults;
  last_nunchuk_ = counts;
}

void Decoder::TakeClassic(const std::optional<reports::ClassicCounts>& counts, Decoded& decoded) {
  if (!counts) return;
  stream::GamepadSample& sample = decoded.gamepad.emplace(decode::ToGamepad(*counts));
  sample.repeated = last_gamepad_ && decode::SameReading(*last_gamepad_, sample);
  last_gamepad_ = sample;
}

Decoded Decoder::TakeButtons(std::uint16_t buttons) {
  Decoded decoded;
  if (!has_last_ || buttons == last_.buttons) return decoded;
  last_.buttons = buttons;
  stream::MotionSample& sample = decoded.motion.emplace_back(last_);
  sample.repeated = true;
  sample.has_angular_velocity = false;
  sample.angular_velocity_radps.setZero();
  decoded.buttons_only = true;
  return decoded;
}

decode::Decoded Wiimote::Take(const handshake::HandshakeSequencer& sequencer,
                              const reports::InputReport& report) {
  const handshake::ExtensionPort& port = sequencer.port();
  const Setup setup = {sequencer.acceleration(), port.nunchuk, sequencer.motion_plus().calibration,
                       port.ready() ? sequencer.extension() : stream::Extension::kUnspecified,
                       port.epoch()};
  return decoder_.Take(setup, report);
}

void Wiimote::AddTo(const handshake::HandshakeSequencer& sequencer,
                    stream::DeviceStatus& status) const {
  status.calibration = sequencer.acceleration_origin();
  status.extension_calibration = sequencer.extension_origin();
  status.gyroscope_calibration = sequencer.gyroscope_origin();
  status.extension_changes = sequencer.port().changes();
  if (!sequencer.status()) return;
  status.battery_low = sequencer.status()->battery_low;
  status.battery_fraction = reports::BatteryFraction(sequencer.status()->battery);
}

}  // namespace footing::wiimote
