#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/stream/device.h"
#include "daemon/sensor/reports/acceleration.h"
#include "daemon/sensor/reports/budget.h"
#include "daemon/sensor/reports/camera_switch.h"
#include "daemon/sensor/reports/extension_port.h"
#include "daemon/sensor/reports/keep_alive.h"
#include "daemon/sensor/reports/handshake_motion_plus.h"
#include "daemon/sensor/reports/plan.h"
#include "daemon/sensor/reports/question.h"
#include "daemon/sensor/reports/status_watch.h"
#include "daemon/sensor/reports/input_report.h"

namespace footing::handshake {

struct HandshakeConfig {
  bool motion_plus = true;       ///< Look for one and use it.
  bool camera = false;           ///< Switch the infrared camera on.
  double status_interval_s = 0;  ///< Ask for the status at this interval; 0 never.
  /// A MotionPlus is off the port for some 20 ms when it is switched: this long "no extension"
  /// means nothing.
  double dead_window_s = 0.1;
  /// A MotionPlus plugged into an empty port shows in no report: it is looked for at this interval.
  double motion_plus_poll_s = 10;
  QuestionConfig question;
  PortCheck::Config port;
  KeepAliveConfig keep_alive;
};

/// Brings one device that speaks the Wiimote's protocol to life and keeps it there: reports in,
/// reports to send out, time as an argument.
///
///  status -> acceleration blocks -> key -> plain -> identity -> Nunchuk block -> camera -> mode ->
///  live -> MotionPlus: key -> identity -> block -> activate -> verify -> mode -> live
///
/// The part from "key" to the Nunchuk's block runs when the status shows an extension. A device
/// that is not a remote (by its plan, found by name or by what answers at the port) reads its
/// plan's blocks instead. Once live it stays live: an extension that comes or goes starts again at
/// "key" while data flow. One question is outstanding at a time. No answer is ever fatal: without
/// calibration the device is live and says so. Reports that others caused (the kernel's driver
/// writes to the same device) are tolerated. Whatever comes in, no more is sent than a bounded
/// number of reports a second.
class HandshakeSequencer {
 public:
  using Outputs = std::vector<reports::OutputReport>;

  /// Starts with `plan`; what answers at the port may change it to another of `plans`. Both outlive
  /// this.
  HandshakeSequencer(const HandshakeConfig& config, const Plan& plan,
                     std::span<const Plan* const> plans);

  /// Time passes: call at least every 10 ms. Appends what is to be sent.
  void Advance(std::int64_t now_ns, Outputs& outputs);
  /// One report arrived.
  void Take(std::int64_t now_ns, const reports::InputReport& report, Outputs& outputs);

  /// Asks for the status report; at most once a second, false when that is too soon.
  bool RequestStatus(std::int64_t now_ns) { return status_.Request(now_ns); }
  void SetCamera(bool on);

  const Plan& plan() const { return *plan_; }
  Step step() const { return question_.step(); }
  /// Data reports may be decoded: plan and calibration are settled.
  bool live() const { return live_; }
  /// Id of the data reports asked for.
  std::uint8_t mode() const { return mode_; }
  bool camera() const { return camera_.wanted; }
  /// What is plugged into a remote, an active MotionPlus included; kNone for other kinds.
  stream::Extension extension() const;
  const ExtensionPort& port() const { return port_; }
  const MotionPlus& motion_plus() const { return motion_plus_; }
  const calibration::AccelerationCalibration& acceleration() const { return acceleration_; }
  /// Origin of the acceleration's calibration.
  stream::CalibrationOrigin acceleration_origin() const;
  /// Of a Nunchuk; kUnspecified when there is none.
  stream::CalibrationOrigin extension_origin() const;
  /// Of a MotionPlus; kUnspecified when there is none.
  stream::CalibrationOrigin gyroscope_origin() const;
  /// The plan's blocks, as far as they were read; one that the device refused is empty.
  const std::vector<std::vector<std::uint8_t>>& blocks() const { return blocks_; }
  /// The newest status report.
  const std::optional<reports::Status>& status() const { return status_.newest; }
  std::uint64_t mode_reasserts() const { return keep_alive_.reasserts(); }
  /// What is wrong with the link, or of a remote with its calibration and accessories, and what to
  /// do; empty when all is well.
  std::string Note(std::int64_t now_ns) const;

 private:
  void Enter(Step step) { question_.Enter(step); }
  void EnterBlock();
  void EnterMode();
  void EnterCameraOrMode();
  void Ask(std::int64_t now_ns, Outputs& outputs);
  reports::OutputReport Output() const;
  /// On to what comes after the step: it was acknowledged, or nobody answers.
  void Proceed();
  void ProceedWithCamera();
  void Watch(std::int64_t now_ns, Outputs& outputs);
  void WatchStatus(std::int64_t now_ns, Outputs& outputs);
  void WatchPort(std::int64_t now_ns, Outputs& outputs);
  void WatchExtension(std::int64_t now_ns, const reports::Data& data);
  void BecomeLive();
  void TakeStatus(std::int64_t now_ns, const reports::Status& status);
  void TakeMemory(const reports::MemoryData& memory);
  void TakeData(std::int64_t now_ns, const reports::Data& data);
  void FinishRead(const std::vector<std::uint8_t>& bytes);
  void TakeIdentity(const std::vector<std::uint8_t>& bytes);
  void TakeMotionPlusIdentity(const std::vector<std::uint8_t>& bytes);
  void TakeVerification(const std::vector<std::uint8_t>& bytes);
  void EnterAfterAcceleration();
  void EnterAfterIdentity();
  void EnterAfterChild();
  void StartOver();
  bool extension_found() const { return port_.has_child() || motion_plus_.active(); }
  std::uint8_t WantedMode() const;
  std::uint8_t CameraFormat() const;

  HandshakeConfig config_;
  const Plan* plan_;
  std::span<const Plan* const> plans_;
  std::uint8_t mode_;
  bool live_ = false;
  bool answered_ = false;  // It ever answered anything.
  std::int64_t now_ns_ = 0;
  Budget writes_{40, 10};
  Question question_;
  ExtensionPort port_;
  PortCheck port_check_;
  bool check_after_ = false;  // The port is to be checked once it is live again.
  MotionPlus motion_plus_;
  CameraSwitch camera_;
  bool has_acceleration_ = false;
  calibration::AccelerationCalibration acceleration_;
  std::vector<std::vector<std::uint8_t>> blocks_;
  StatusWatch status_;
  KeepAlive keep_alive_;
};

}  // namespace footing::handshake
