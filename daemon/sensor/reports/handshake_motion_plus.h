#pragma once

#include <cstdint>
#include <utility>

#include "daemon/sensor/reports/calibration_motion_plus.h"

namespace footing::handshake {

/// A remote's MotionPlus: whether it is switched on, and whether somebody else keeps switching it
/// off.
class MotionPlus {
 public:
  bool active() const { return active_; }
  /// It is found switched on, as nobody asked for: used as it is, without its calibration.
  void TakeFound();
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

}  // namespace footing::handshake
