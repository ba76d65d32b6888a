#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/stream/device.h"
#include "daemon/sensor/calibration/acceleration.h"
#include "daemon/sensor/calibration/board.h"
#include "daemon/sensor/reports/extension.h"
#include "daemon/sensor/reports/input_report.h"
#include "daemon/sensor/reports/memory_read.h"
#include "daemon/sensor/reports/output_report.h"

namespace footing::handshake {

struct HandshakeConfig {
  double reply_timeout_s = 0.5;  ///< A status or memory read not answered is asked again.
  double ack_timeout_s = 0.2;    ///< Some devices never acknowledge a write.
  int tries = 3;                 ///< Of each question; then the next step is taken without it.
  double settle_s = 0.1;         ///< Before an extension that is not ready is asked again.
  double silence_s = 0.2;        ///< Without data of the mode: the mode is set again.
  double reassert_min_s = 0.25;  ///< Between two tries to set the mode again; doubles up to max.
  double reassert_max_s = 2;
  double after_status_s = 0.08;  ///< After an unasked status report the mode is set again.
};

/// The steps from a device that just appeared to one that sends what we want.
///
///  status -> [extension: key -> plain -> identity] -> Wiimote: acceleration blocks   -> mode ->
///  live
///                                                     board: block -> temperature    -^
/// The part in brackets runs when the status shows an extension or the name is that of a board.
enum class Step {
  kStatus,
  kExtensionKey,
  kExtensionPlain,
  kExtensionIdentity,
  kAccelerationBlocks,
  kBoardBlock,
  kBoardTemperature,
  kMode,
  kLive,
};

/// Brings one device to life and keeps it there: reports in, reports to send out, time as an
/// argument. One question is outstanding at a time. No answer is ever fatal: without calibration
/// the device is live and says so. Reports that others caused (the kernel's driver talks to the
/// same device) are tolerated; when they change the mode it is set again, at a limited rate.
class Handshake {
 public:
  using Outputs = std::vector<reports::OutputReport>;

  Handshake(const HandshakeConfig& config, const std::string& product_name);

  /// Time passes: call at least every 50 ms. Appends what is to be sent.
  void Advance(std::int64_t now_ns, Outputs& outputs);
  /// One report arrived.
  void Take(std::int64_t now_ns, const reports::InputReport& report, Outputs& outputs);

  Step step() const { return step_; }
  /// Data reports may be decoded: kind and calibration are settled.
  bool live() const { return step_ == Step::kLive; }
  stream::DeviceKind kind() const { return kind_; }
  /// Id of the data reports asked for: 0x31, 0x35 or 0x34.
  std::uint8_t mode() const;
  const calibration::AccelerationCalibration& acceleration() const { return acceleration_; }
  const calibration::BoardCalibration& board() const { return board_; }
  stream::CalibrationOrigin calibration_origin() const;
  /// The newest status report.
  const std::optional<reports::Status>& status() const { return status_; }
  /// What is wrong and what to do, for a person; empty when all is well.
  std::string Note(std::int64_t now_ns) const;

 private:
  void Enter(Step step);
  void Ask(std::int64_t now_ns, Outputs& outputs);
  void GiveUp();
  void KeepAlive(std::int64_t now_ns, Outputs& outputs);
  void TakeStatus(std::int64_t now_ns, const reports::Status& status);
  void TakeMemory(const reports::MemoryData& memory);
  void TakeAcknowledgement(const reports::Acknowledgement& acknowledgement);
  void TakeData(std::int64_t now_ns, const reports::Data& data);
  void FinishRead(const std::vector<std::uint8_t>& bytes);
  void IdentifyExtension(const std::vector<std::uint8_t>& bytes);
  Step AfterExtension() const;

  HandshakeConfig config_;
  bool named_board_;
  stream::DeviceKind kind_;
  Step step_ = Step::kStatus;

  // The question that is out.
  bool asked_ = false;
  std::int64_t asked_ns_ = 0;
  int tries_ = 0;
  std::int64_t not_before_ns_ = 0;
  bool settle_ = false;
  std::optional<reports::MemoryRead> read_;

  int identity_tries_ = 0;
  bool extension_ = false;
  std::optional<reports::Status> status_;
  bool has_acceleration_ = false;
  calibration::AccelerationCalibration acceleration_;
  std::vector<std::uint8_t> board_block_;
  calibration::BoardCalibration board_ = calibration::DefaultBoard();

  // While live.
  std::int64_t data_ns_ = 0;
  std::int64_t reassert_ns_ = 0;
  double reassert_s_ = 0;
};

}  // namespace footing::handshake
