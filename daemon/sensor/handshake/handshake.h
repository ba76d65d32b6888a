#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/stream/device.h"
#include "daemon/sensor/calibration/acceleration.h"
#include "daemon/sensor/calibration/board.h"
#include "daemon/sensor/calibration/motion_plus.h"
#include "daemon/sensor/calibration/nunchuk.h"
#include "daemon/sensor/handshake/budget.h"
#include "daemon/sensor/handshake/keep_alive.h"
#include "daemon/sensor/handshake/step.h"
#include "daemon/sensor/reports/extension.h"
#include "daemon/sensor/reports/input_report.h"

namespace footing::handshake {

struct HandshakeConfig {
  bool motion_plus = true;       ///< Look for one and use it.
  bool camera = false;           ///< Switch the infrared camera on.
  double status_interval_s = 0;  ///< Ask for the status so often; 0 never.
  double reply_timeout_s = 0.5;  ///< A status or memory read not answered is asked again.
  double ack_timeout_s = 0.2;    ///< Some devices never acknowledge a write.
  int tries = 3;                 ///< Of each question; then the next step is taken without it.
  double settle_s = 0.1;         ///< Before an extension that is not ready is asked again.
  /// A MotionPlus is off the port for some 20 ms when it is switched: for so long "no extension"
  /// means nothing.
  double dead_window_s = 0.1;
  /// A MotionPlus plugged into an empty port shows in no report: it is looked for so often.
  double motion_plus_poll_s = 10;
  double redo_min_s = 0.25;  ///< Between two looks at an extension that will not settle; doubles.
  double redo_max_s = 30;
  KeepAliveConfig keep_alive;
};

/// Brings one Wiimote or Balance Board to life and keeps it there: reports in, reports to send
/// out, time as an argument.
///
///  status -> acceleration blocks -> key -> plain -> identity -> Nunchuk block -> camera -> mode ->
///  live -> MotionPlus: key -> identity -> block -> activate -> verify -> mode -> live
///
/// The part from "key" to the Nunchuk's block runs when the status shows an extension. A board (by
/// name or extension identity) reads its own block and temperature instead. Once live it stays so:
/// an extension that comes or goes starts again at "key" while data flow. One question
/// is outstanding at a time. No answer is ever fatal: without calibration the device is live and
/// says so. Reports that others caused (the kernel's driver talks to the same device) are
/// tolerated. Whatever comes in, no more is sent than a bounded number of reports a second.
class Handshake {
 public:
  using Outputs = std::vector<reports::OutputReport>;

  Handshake(const HandshakeConfig& config, const std::string& product_name);

  /// Time passes: call at least every 10 ms. Appends what is to be sent.
  void Advance(std::int64_t now_ns, Outputs& outputs);
  /// One report arrived.
  void Take(std::int64_t now_ns, const reports::InputReport& report, Outputs& outputs);

  /// Asks for the status report; at most once a second, false when that is too soon.
  bool RequestStatus(std::int64_t now_ns);
  void SetCamera(bool on);

  Step step() const { return step_; }
  /// Data reports may be decoded: kind and calibration are settled.
  bool live() const { return live_; }
  stream::DeviceKind kind() const { return kind_; }
  /// Id of the data reports asked for: 0x31, 0x33, 0x34, 0x35 or 0x37.
  std::uint8_t mode() const;
  bool camera() const { return config_.camera; }
  /// What is plugged in, an active MotionPlus included; kNone for boards.
  stream::Extension extension() const;
  /// The extension's bytes mean what extension() says: not while it is being looked at.
  bool extension_ready() const { return live_ && extension_ready_; }
  /// Counts the times that extension_ready() came true.
  std::uint64_t extension_epoch() const { return extension_epoch_; }
  std::uint64_t extension_changes() const { return extension_changes_; }
  const calibration::AccelerationCalibration& acceleration() const { return acceleration_; }
  const calibration::NunchukCalibration& nunchuk() const { return nunchuk_; }
  const calibration::MotionPlusCalibration& motion_plus() const { return motion_plus_; }
  const calibration::BoardCalibration& board() const { return board_; }
  stream::CalibrationOrigin calibration_origin() const;
  /// Of a Nunchuk; kUnspecified when there is none.
  stream::CalibrationOrigin extension_origin() const;
  /// Of a MotionPlus; kUnspecified when there is none.
  stream::CalibrationOrigin gyroscope_origin() const;
  /// The newest status report.
  const std::optional<reports::Status>& status() const { return status_; }
  std::uint64_t mode_reasserts() const { return keep_alive_.reasserts(); }
  /// What is wrong and what to do, for a person; empty when all is well.
  std::string Note(std::int64_t now_ns) const;

 private:
  bool is_board() const { return kind_ == stream::DeviceKind::kBalanceBoard; }
  bool has_child() const { return child_ != reports::Extension::kNotReady; }
  void Enter(Step step);
  void EnterMode();
  void Ask(std::int64_t now_ns, Outputs& outputs);
  reports::OutputReport Output() const;
  /// On to what comes after the step: it was acknowledged, or nobody answers.
  void Proceed();
  void Watch(std::int64_t now_ns, Outputs& outputs);
  void WatchExtension(std::int64_t now_ns, const reports::Data& data);
  /// Looks at the extension again soon, at a rate that falls while it keeps changing.
  void WantRedo(std::int64_t now_ns);
  void StartOver();
  void BecomeLive();
  void TakeStatus(std::int64_t now_ns, const reports::Status& status);
  void TakeMemory(const reports::MemoryData& memory);
  void TakeAcknowledgement(const reports::Acknowledgement& acknowledgement);
  void TakeData(std::int64_t now_ns, const reports::Data& data);
  void FinishRead(const std::vector<std::uint8_t>& bytes);
  void TakeIdentity(const std::vector<std::uint8_t>& bytes);
  void TakeMotionPlusIdentity(const std::vector<std::uint8_t>& bytes);
  void TakeVerification(const std::vector<std::uint8_t>& bytes);
  /// True when a block that makes no sense is read once more.
  bool ReadAgain(stream::CalibrationOrigin origin);
  Step AfterAcceleration() const;
  Step AfterIdentity() const;
  Step AfterChild() const;
  /// Something else, as the kernel's driver, keeps switching the MotionPlus off.
  bool motion_plus_given_up() const;
  void EnterAfterMotionPlus();
  std::uint8_t WantedMode() const;
  std::uint8_t CameraFormat() const;

  HandshakeConfig config_;
  bool named_board_;
  stream::DeviceKind kind_;
  std::uint8_t mode_;
  Step step_ = Step::kStatus;
  bool live_ = false;
  std::int64_t now_ns_ = 0;
  Budget writes_{40, 10};

  // The question that is out.
  bool asked_ = false;
  std::int64_t asked_ns_ = 0;
  int tries_ = 0;
  double pause_s_ = 0;  // Before the next question.
  std::int64_t not_before_ns_ = 0;
  std::optional<reports::MemoryRead> read_;
  bool read_again_ = false;
  bool answered_ = false;      // It ever answered anything.
  bool acknowledges_ = true;   // Until it did not.
  bool acknowledged_ = false;  // It ever did.

  // Extension.
  int identity_tries_ = 0;
  int activations_ = 0;
  reports::Extension child_ = reports::Extension::kNotReady;  // kNotReady: none.
  bool motion_plus_active_ = false;
  std::int64_t activated_ns_ = 0;
  bool motion_plus_lost_ = false;  // It was active and is no longer, by nothing we did.
  int motion_plus_undone_ = 0;     // So often in a row, soon after it was switched on.
  bool extension_ready_ = false;
  stream::Extension published_ = stream::Extension::kUnspecified;
  std::uint64_t extension_epoch_ = 0;
  std::uint64_t extension_changes_ = 0;
  int child_bit_differs_ = 0;           // Packets in a row that say other than has_child().
  std::int64_t extension_data_ns_ = 0;  // Its bytes last made sense.
  std::int64_t dead_until_ns_ = 0;
  bool redo_due_ = false;
  bool redo_after_ = false;
  std::int64_t redo_ns_ = 0;
  double redo_wait_s_ = 0;
  std::int64_t redone_ns_ = 0;
  bool polling_ = false;
  std::int64_t poll_ns_ = 0;
  std::uint8_t camera_format_ = 0;  // As it was set; 0 off.
  bool camera_due_ = false;

  bool has_acceleration_ = false;
  calibration::AccelerationCalibration acceleration_;
  calibration::NunchukCalibration nunchuk_;
  calibration::MotionPlusCalibration motion_plus_;
  std::vector<std::uint8_t> board_block_;
  bool has_board_ = false;
  calibration::BoardCalibration board_ = calibration::DefaultBoard();

  // While live.
  std::optional<reports::Status> status_;
  bool status_due_ = false;
  bool status_wanted_ = false;
  std::int64_t status_asked_ns_ = 0;
  KeepAlive keep_alive_;
};

}  // namespace footing::handshake
