#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "daemon/sensor/reports/input_report.h"

namespace footing::handshake {

/// Status reports of a live device: the newest, and when the next one is asked for.
class StatusWatch {
 public:
  static constexpr std::int64_t kSpacingNs = 1'000'000'000;

  /// At most once a second; false when that is too soon.
  bool Request(std::int64_t now_ns) {
    if (asked_ns_ != 0 && now_ns - asked_ns_ < kSpacingNs) return false;
    due_ = true;
    asked_ns_ = now_ns;
    return true;
  }
  void SetAsked(std::int64_t now_ns) { asked_ns_ = now_ns; }
  std::int64_t asked_ns() const { return asked_ns_; }

  bool due() const { return due_; }
  void SetSent() {
    due_ = false;
    wanted_ = true;
  }
  /// True when the report that just came was asked for.
  bool TakeWanted() { return std::exchange(wanted_, false); }

  std::optional<reports::Status> newest;

 private:
  bool due_ = false;
  bool wanted_ = false;
  std::int64_t asked_ns_ = 0;
};

}  // namespace footing::handshake
