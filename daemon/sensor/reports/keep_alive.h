#pragma once

#include <cstdint>

#include "daemon/sensor/reports/budget.h"

namespace footing::handshake {

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
  void TakeData(std::int64_t now_ns);
  /// Any status report, wanted or not.
  void TakeStatus(std::int64_t now_ns);
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

}  // namespace footing::handshake
