#include "daemon/offline/eval/jump_events.h"

namespace footing::eval {

void JumpEvents::Decide(bool recognised, bool late) {
  begun_s_.reset();
  ++meant_count_;
  recognised_ += recognised ? 1 : 0;
  late_ += late ? 1 : 0;
}

void JumpEvents::Add(double time_s, bool meant, bool commanded, double delay_s) {
  if (meant && !meant_) {
    if (begun_s_) Decide(false, false);  // The next gesture comes before the last one's command.
    begun_s_ = time_s;
  }
  if (meant) meant_s_ = time_s;
  meant_ = meant;
  const bool lately = meant_s_ && time_s - *meant_s_ <= delay_s;
  if (commanded && !commanded_) {
    ++commanded_count_;
    not_meant_ += lately ? 0 : 1;
  }
  commanded_ = commanded;
  if (!begun_s_) return;
  overdue_ = time_s - *begun_s_ > delay_s;
  if (commanded) {
    Decide(true, overdue_);
  } else if (!lately) {
    Decide(false, false);
  }
}

void JumpEvents::Restart() {
  if (begun_s_ && overdue_) Decide(false, false);
  begun_s_.reset();
  meant_ = commanded_ = overdue_ = false;
}

void JumpEvents::Pool(const JumpEvents& other) {
  meant_count_ += other.meant_count_;
  recognised_ += other.recognised_;
  late_ += other.late_;
  commanded_count_ += other.commanded_count_;
  not_meant_ += other.not_meant_;
}

}  // namespace footing::eval
