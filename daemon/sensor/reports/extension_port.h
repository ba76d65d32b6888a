#pragma once

#include <cstdint>
#include <optional>

#include "common/stream/device.h"
#include "daemon/sensor/reports/nunchuk.h"
#include "daemon/sensor/reports/extension.h"

namespace footing::handshake {

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
  bool Take(std::int64_t now_ns);
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

  /// What is sent now makes the port disappear for a while, when "no extension" means nothing.
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
  void TakeSense(std::int64_t now_ns) { sense_ns_ = now_ns; }
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

}  // namespace footing::handshake
