#include "clients/study/session/anticipation.h"

#include "common/base/units.h"

namespace footing::study {

void Anticipation::Add(const Sight& frame) {
  const bool now_commanded = frame.commanded == frame.wanted;
  const bool now_ahead = frame.to_mark_m > 0;
  if (now_ahead && !ahead_) answered_ = now_commanded;  // A new approach.
  if (!now_ahead && ahead_) {
    line_ns_ = frame.host_ns;
    const bool in_force = commanded_ || frame.running == frame.wanted;
    if (!in_force) {
      command_ns_ = 0;
      answered_ = false;
    }
  }
  if (now_commanded && !commanded_ && (now_ahead || !answered_)) {
    command_ns_ = frame.host_ns;
    answered_ = true;
  }
  commanded_ = now_commanded;
  ahead_ = now_ahead;
}

std::optional<double> Anticipation::seconds() const {
  if (command_ns_ == 0 || line_ns_ == 0) return std::nullopt;
  return NanosecondsToSeconds(line_ns_ - command_ns_);
}

}  // namespace footing::study
