#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "common/net/token_bucket.h"
#include "daemon/sensor/service/log_line.h"

namespace footing::sensor {

/// Lines for the log that others cause, limited to 20 at once and 2 a second: a device that comes
/// and goes in a loop fills neither the disk nor the loop's time. The first line after some were
/// left out says how many.
class LimitedLog {
 public:
  explicit LimitedLog(std::function<void(const LogLine&)> say) : say_(std::move(say)) {}

  void Say(LogLine line, std::int64_t now_ns) {
    if (!bucket_.Take(now_ns)) {
      ++left_out_;
      return;
    }
    const auto before = std::exchange(left_out_, 0);
    if (before != 0) line.text += " (" + std::to_string(before) + " lines before were left out)";
    say_(line);
  }

 private:
  std::function<void(const LogLine&)> say_;
  transport::TokenBucket bucket_{2, 20};
  std::uint64_t left_out_ = 0;
};

}  // namespace footing::sensor
