#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/stream/device.h"
#include "daemon/sensor/reports/handshake.h"
#include "daemon/sensor/reports/input_report.h"
#include "daemon/sensor/reports/wiimote_calibration.h"

namespace footing::handshake {

/// How many writes, or fresh starts, are still allowed: `capacity` at once, then `rate_hz` of them.
class Budget {
 public:
  Budget(double capacity, double rate_hz)
      : capacity_(capacity), rate_hz_(rate_hz), left_(capacity) {}

  /// Spends one; false when none is left.
  bool Spend(std::int64_t now_ns) {
    if (started_) {
      left_ = std::min(capacity_, left_ + rate_hz_ * 1e-9 * static_cast<double>(now_ns - last_ns_));
    }
    started_ = true;
    last_ns_ = now_ns;
    if (left_ < 1) return false;
    left_ -= 1;
    return true;
  }

 private:
  double capacity_;
  double rate_hz_;
  double left_;
  bool started_ = false;
  std::int64_t last_ns_ = 0;
};

/// Whether a remote's infrared camera is wanted, and in which format it was set up.
struct CameraSwitch {
  bool wanted = false;
  bool changed = false;     ///< Wanted otherwise than before, not yet applied.
  std::uint8_t format = 0;  ///< As it was set up; 0: off.

  void Want(bool on) {
    changed = changed || on != wanted;
    wanted = on;
  }
  bool NeedsSetUp(std::uint8_t wanted_format) const { return wanted && format != wanted_format; }
};

/// When a remote's port is examined again: soon, at a rate that falls while it keeps changing.
class PortCheck {
 public:
  struct Config {
    double settle_s = 0.1;  ///< Before an extension that is not ready is asked again.
    double min_s = 0.25;    ///< Between two checks of an extension that will not settle; doubles.
    double max_s = 30;
  };

  explicit PortCheck(const Config& config) : config_(config) {}

  void Request(std::int64_t now_ns);
  bool requested() const { return requested_; }
  /// True once, when a requested check is due.
  bool BeginIfDue(std::int64_t now_ns);
  /// A check ended.
  void SetDone(std::int64_t now_ns) { done_ns_ = now_ns; }

 private:
  Config config_;
  bool requested_ = false;
  std::int64_t due_ns_ = 0;
  double wait_s_ = 0;
  std::int64_t done_ns_ = 0;
};

/// A remote's extension port: what is plugged in, and whether its bytes make sense. A MotionPlus is
/// not its matter, but what is plugged into the MotionPlus is.
class ExtensionPort {
 public:
  /// kNotReady: nothing is plugged in.
  reports::Extension child() const { return child_; }
  void set_child(reports::Extension child) { child_ = child; }
  bool has_child() const { return child_ != reports::Extension::kNotReady; }

  /// An identity came that cannot be the last word; true while it is to be asked for again.
  bool AskAgain(int tries) { return ++identity_tries_ < tries; }
  void GiveUp(int tries) { identity_tries_ = tries; }
  /// The examination begins again.
  void StartOver();

  /// The report sent now makes the port disappear for a while, when "no extension" means nothing.
  void Disturb(std::int64_t until_ns);
  bool disturbed(std::int64_t now_ns) const { return now_ns < disturbed_until_ns_; }

  /// The extension's bytes mean what the device's extension() says.
  bool ready() const { return ready_; }
  void set_unready() { ready_ = false; }
  void BecomeReady(std::int64_t now_ns);
  /// Counts the times that ready() became true.
  std::uint64_t epoch() const { return epoch_; }

  /// Counts the changes of what is published.
  void Publish(stream::Extension extension);
  std::uint64_t changes() const { return changes_; }

  /// Its bytes made sense, or there were none to check.
  void OnSense(std::int64_t now_ns) { sense_ns_ = now_ns; }
  bool Senseless(std::int64_t now_ns) const;

  calibration::NunchukCalibration nunchuk;

 private:
  reports::Extension child_ = reports::Extension::kNotReady;
  int identity_tries_ = 0;
  bool ready_ = false;
  std::uint64_t epoch_ = 0;
  stream::Extension published_ = stream::Extension::kUnspecified;
  std::uint64_t changes_ = 0;
  std::int64_t sense_ns_ = 0;
  std::int64_t disturbed_until_ns_ = 0;
};

/// Times after which the data mode is set again.
struct KeepAliveConfig {
  /// A status report stops the data, or makes the kernel's driver set a mode of its own at once:
  /// the mode is set again so soon after it ...
  double after_status_s = 0.005;
  /// ... and once more, when no data came by then.
  double second_try_s = 0.06;
  double silence_s = 0.2;        ///< Without data of the mode: the mode is set again.
  double reassert_min_s = 0.25;  ///< Between further tries; doubles up to max.
  double reassert_max_s = 2;
  double ask_after_s = 5;  ///< After this silence the status is asked for too.
};

/// Keeps a live device in its report mode: reports what arrived, says what to send. The kernel's
/// driver hid-wiimote sends its own mode after every status report, whoever asked for it.
class KeepAlive {
 public:
  enum class Action { kNone, kSetMode, kAskStatus };

  explicit KeepAlive(const KeepAliveConfig& config = {}) : config_(config) {}

  /// Data of the mode asked for arrived, or the device just became live.
  void OnData(std::int64_t now_ns);
  /// Any status report, wanted or not.
  void OnStatus(std::int64_t now_ns);
  Action Advance(std::int64_t now_ns);
  /// Time jumped, as after a suspension: silence counts from now.
  void Shift(std::int64_t now_ns) { data_ns_ = now_ns; }

  double SilenceS(std::int64_t now_ns) const {
    return static_cast<double>(now_ns - data_ns_) * 1e-9;
  }
  /// How often the mode was set again since the device became live.
  std::uint64_t reasserts() const { return reasserts_; }

 private:
  Action SetMode();

  KeepAliveConfig config_;
  // Both tries after a status; a device that floods status reports cannot make us flood it.
  Budget after_status_{8, 4};
  std::int64_t data_ns_ = 0;
  bool first_due_ = false;
  bool second_due_ = false;
  std::int64_t first_ns_ = 0;
  std::int64_t second_ns_ = 0;
  std::int64_t next_ns_ = 0;
  double wait_s_ = 0;
  std::int64_t asked_ns_ = 0;
  std::uint64_t reasserts_ = 0;
};

/// A remote's MotionPlus: whether it is switched on, and whether somebody else keeps switching it
/// off.
class MotionPlus {
 public:
  bool active() const { return active_; }
  /// It is found switched on, as nobody asked for: used as it is, without its calibration.
  void OnFoundActive();
  /// Right after an activation; true when it is to be activated again.
  bool TakeVerification(bool active, std::int64_t now_ns, int tries);
  /// The examination of the port begins again, which switches it off.
  void StartOver();

  /// It may be gone: the port says so, and nothing that was sent explains it.
  void Suspect() { lost_ = lost_ || active_; }
  /// It answers at its inactive place, or not; counts how often it was switched off.
  void TakeInactive(bool found, std::int64_t now_ns);
  /// Something else, as the kernel's driver, keeps switching it off.
  bool given_up() const;

  /// A packet says whether something is plugged into it; true when so many in a row differ from
  /// `known` that it must have changed.
  bool ChildChanged(bool connected, bool known);
  void ForgetChildBits() { child_bit_differs_ = 0; }

  /// One that is plugged into an empty port shows in no report.
  bool polling() const { return polling_; }
  bool StartPoll(std::int64_t now_ns, std::int64_t interval_ns);
  bool EndPoll() { return std::exchange(polling_, false); }
  void PollAt(std::int64_t at_ns) { poll_ns_ = at_ns; }

  calibration::MotionPlusCalibration calibration;

 private:
  bool active_ = false;
  int activations_ = 0;
  std::int64_t activated_ns_ = 0;
  bool lost_ = false;  // It was active and is no longer, by nothing we did.
  int undone_ = 0;     // How often in a row, soon after it was switched on.
  int child_bit_differs_ = 0;
  bool polling_ = false;
  std::int64_t poll_ns_ = 0;
};

/// Status reports of a live device: the newest, and when the next one is asked for.
class StatusWatch {
 public:
  static constexpr std::int64_t kSpacingNs = 1'000'000'000;

  /// At most once a second; false when that is too soon.
  bool Request(std::int64_t now_ns) {
    if (asked_ns_ != 0 && now_ns - asked_ns_ < kSpacingNs) return false;
    due_ = true;
    asked_ns_ = now_ns;
    return true;
  }
  void SetAsked(std::int64_t now_ns) { asked_ns_ = now_ns; }
  std::int64_t asked_ns() const { return asked_ns_; }

  bool due() const { return due_; }
  void SetSent() {
    due_ = false;
    wanted_ = true;
  }
  /// True when the report that just came was asked for.
  bool TakeWanted() { return std::exchange(wanted_, false); }

  std::optional<reports::Status> newest;

 private:
  bool due_ = false;
  bool wanted_ = false;
  std::int64_t asked_ns_ = 0;
};

/// Settings of the handshake with a Wiimote.
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
  /// Extension in a remote's port, an active MotionPlus included; kNone for other kinds.
  stream::Extension extension() const;
  const ExtensionPort& port() const { return port_; }
  const MotionPlus& motion_plus() const { return motion_plus_; }
  const calibration::AccelerationCalibration& acceleration() const { return acceleration_; }
  /// Origin of the acceleration's calibration.
  stream::CalibrationOrigin acceleration_origin() const;
  /// Origin of a Nunchuk's calibration; kUnspecified when there is none.
  stream::CalibrationOrigin extension_origin() const;
  /// Origin of a MotionPlus' calibration; kUnspecified when there is none.
  stream::CalibrationOrigin gyroscope_origin() const;
  /// The plan's blocks, as far as they were read; one that the device refused is empty.
  const std::vector<std::vector<std::uint8_t>>& blocks() const { return blocks_; }
  /// The newest status report.
  const std::optional<reports::Status>& status() const { return status_.newest; }
  std::uint64_t mode_reasserts() const { return keep_alive_.reasserts(); }
  /// Text for a person: a problem with the link, or with a remote's calibration and accessories,
  /// and what to do; empty when all is well.
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
