#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "common/stream/device.h"
#include "daemon/sensor/kinds/decoded.h"
#include "daemon/sensor/kinds/wiimote_protocol.h"
#include "daemon/sensor/reports/input_report.h"
#include "daemon/sensor/reports/sequencer.h"
#include "daemon/sensor/reports/wiimote_calibration.h"

namespace footing::wiimote {

/// Results of the handshake with a Wiimote.
struct Setup {
  const calibration::AccelerationCalibration& acceleration;
  const calibration::NunchukCalibration& nunchuk;
  const calibration::MotionPlusCalibration& motion_plus;
  /// Meaning of the extension bytes; kUnspecified while it is not known.
  stream::Extension extension = stream::Extension::kUnspecified;
  std::uint64_t extension_epoch = 0;  ///< Changes when the extension starts again.
};

/// Reports of a Wiimote with Nunchuk, Classic Controller, MotionPlus (packets in turn with its
/// child's, so each at half the rate) and camera. A plain value.
class Decoder {
 public:
  /// Any input report. Those without acceleration give a sample only when they show other buttons,
  /// so that no edge is lost in a status or memory reply.
  decode::Decoded Take(const Setup& setup, const reports::InputReport& report);

 private:
  void TakeExtension(const Setup& setup, reports::Bytes bytes, decode::Decoded& decoded);
  void TakeNunchuk(const Setup& setup, const reports::NunchukCounts& counts,
                   decode::Decoded& decoded);
  void TakeClassic(const std::optional<reports::ClassicCounts>& counts, decode::Decoded& decoded);
  decode::Decoded TakeButtons(std::uint16_t buttons);

  reports::Interleaver interleaver_;
  std::uint64_t extension_epoch_ = 0;
  int packets_to_drop_ = 0;  // The first after a MotionPlus was switched on are rubbish.
  bool has_last_ = false;
  std::array<std::uint16_t, 3> last_counts_{};
  stream::MotionSample last_;
  std::optional<reports::MotionPlusCounts> last_gyroscope_;
  std::optional<reports::NunchukCounts> last_nunchuk_;
  std::optional<stream::GamepadSample> last_gamepad_;
};

/// A Wiimote and what is plugged into it. Of the devices that speak its protocol it is the one that
/// nothing else is recognised by.
class Wiimote : public kinds::Speaker {
 public:
  static constexpr handshake::Plan kPlan = {true, 0x31};

  static bool Matches(const decode::Product&) { return true; }

  explicit Wiimote(const decode::KindOptions&) {}

  stream::DeviceKind kind() const override { return stream::DeviceKind::kWiimote; }
  decode::Placement placement() const override { return decode::Placement::kOnBody; }
  decode::Timing timing() const override { return {0.01, 0.01}; }
  bool has_camera() const override { return true; }

  void Restart() override { decoder_ = Decoder(); }
  decode::Decoded Take(const handshake::HandshakeSequencer& sequencer,
                       const reports::InputReport& report) override;
  void AddTo(const handshake::HandshakeSequencer& sequencer,
             stream::DeviceStatus& status) const override;

 private:
  Decoder decoder_;
};

}  // namespace footing::wiimote
