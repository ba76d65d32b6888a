#include "common/runtime/run_until.h"

#include <boost/asio/executor_work_guard.hpp>
#include <chrono>

#include "common/runtime/timer.h"
#include "common/base/units.h"

namespace footing::timer {

Waited RunUntil(boost::asio::io_context& io, const std::function<bool()>& condition,
                double within_s, const std::function<bool()>& interrupted) {
  const auto work = boost::asio::make_work_guard(io);  // Or it would stop, and not wait.
  const TimePoint end = Now() + std::chrono::nanoseconds(SecondsToNanoseconds(within_s));
  for (;;) {
    if (interrupted()) return Waited::kInterrupted;
    if (condition && condition()) return Waited::kDone;
    if (Now() >= end) return Waited::kTimeUp;
    RunOneUntil(io, end);
  }
}

}  // namespace footing::timer
