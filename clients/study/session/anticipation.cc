#include "clients/study/session/anticipation.h"

#include "common/units/units.h"

namespace footing::study {

void Anticipation::Add(std::int64_t host_ns, double to_mark_m, stream::Gait commanded,
                       stream::Gait wanted) {
  const bool now_commanded = commanded == wanted;
  const bool now_ahead = to_mark_m > 0;
  if (now_ahead && !ahead_) answered_ = now_commanded;  // A new approach.
  if (now_commanded && !commanded_ && (now_ahead || !answered_)) {
    command_ns_ = host_ns;
    answered_ = true;
  }
  if (!now_ahead && ahead_) line_ns_ = host_ns;
  commanded_ = now_commanded;
  ahead_ = now_ahead;
}

std::optional<double> Anticipation::seconds() const {
  if (command_ns_ == 0 || line_ns_ == 0) return std::nullopt;
  return NanosecondsToSeconds(line_ns_ - command_ns_);
}

}  // namespace footing::study
