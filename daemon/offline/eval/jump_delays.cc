#include "daemon/offline/eval/jump_delays.h"

#include <algorithm>
#include <cmath>

namespace footing::eval {

void Delay::Add(double time_s) {
  ++count;
  sum_s += time_s;
  sum_s2 += time_s * time_s;
}

void Delay::Pool(const Delay& other) {
  count += other.count;
  sum_s += other.sum_s;
  sum_s2 += other.sum_s2;
}

double Delay::sd_s() const {
  if (count < 2) return 0;
  const double n = static_cast<double>(count);
  return std::sqrt(std::max(0.0, sum_s2 - sum_s * sum_s / n) / (n - 1));
}

void JumpDelays::Add(double time_s, bool meant, bool commanded, bool jumps, double delay_s) {
  if (meant) meant_s_ = time_s;
  if (time_s - meant_s_ > delay_s) begun_s_.reset();
  // A gesture in a jump, or under a command, asks for nothing new.
  if (meant && !meant_ && !commanded_ && !jumps) begun_s_ = time_s;
  if (commanded && !commanded_ && begun_s_) {
    to_command_.Add(time_s - *begun_s_);
    commanded_s_ = time_s;
    begun_s_.reset();
  }
  if (!commanded) commanded_s_.reset();
  if (jumps && commanded_s_) {
    to_take_off_.Add(time_s - *commanded_s_);
    commanded_s_.reset();
  }
  meant_ = meant;
  commanded_ = commanded;
}

void JumpDelays::Restart() {
  begun_s_.reset();
  commanded_s_.reset();
  meant_ = commanded_ = false;
}

void JumpDelays::Pool(const JumpDelays& other) {
  to_command_.Pool(other.to_command_);
  to_take_off_.Pool(other.to_take_off_);
}

}  // namespace footing::eval
