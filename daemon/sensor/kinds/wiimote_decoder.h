#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "common/stream/device.h"
#include "daemon/sensor/reports/acceleration.h"
#include "daemon/sensor/reports/calibration_motion_plus.h"
#include "daemon/sensor/reports/nunchuk.h"
#include "daemon/sensor/kinds/decoded.h"
#include "daemon/sensor/reports/extension.h"
#include "daemon/sensor/reports/input_report.h"

namespace footing::wiimote {

/// What the handshake found out about a Wiimote.
struct Setup {
  const calibration::AccelerationCalibration& acceleration;
  const calibration::NunchukCalibration& nunchuk;
  const calibration::MotionPlusCalibration& motion_plus;
  /// What the extension bytes are; kUnspecified while nobody knows.
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

}  // namespace footing::wiimote
