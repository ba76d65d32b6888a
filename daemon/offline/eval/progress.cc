#include "daemon/offline/eval/progress.h"

#include <cmath>

namespace footing::eval {

void Progress::Done(double done, std::int64_t now_ns, std::ostream& out) {
  if (now_ns < next_ns_) return;
  next_ns_ = now_ns + kEveryNs;
  out << command_ << ": " << std::llround(std::floor(done)) << " of " << std::llround(total_) << " "
      << unit_ << std::endl;
}

}  // namespace footing::eval
