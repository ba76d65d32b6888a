#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "common/stream/device.h"
#include "daemon/sensor/kinds/decoded.h"
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
class Wiimote {
 public:
  static constexpr stream::DeviceKind kKind = stream::DeviceKind::kWiimote;
  static constexpr decode::Placement kPlacement = decode::Placement::kOnBody;
  static constexpr decode::Timing kTiming = {0.01, 0.01};
  static constexpr handshake::Plan kPlan = {true, 0x31};

  static bool Matches(const decode::Product&) { return true; }

  Wiimote(const decode::KindOptions&, handshake::HandshakeSequencer sequencer)
      : sequencer_(std::move(sequencer)) {}

  handshake::HandshakeSequencer& sequencer() { return sequencer_; }
  const handshake::HandshakeSequencer& sequencer() const { return sequencer_; }
  /// A new uninterrupted stream begins.
  void Restart() { decoder_ = Decoder(); }
  decode::Decoded Take(const reports::InputReport& report);

  void SetCamera(bool on) { sequencer_.SetCamera(on); }
  void AddTo(stream::DeviceStatus& status) const;
  std::string Note() const { return ""; }

 private:
  handshake::HandshakeSequencer sequencer_;
  Decoder decoder_;
};

}  // namespace footing::wiimote
