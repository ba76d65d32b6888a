#pragma once

#include <array>
#include <cstdint>
#include <deque>

#include "common/stream/gait.h"

namespace footing::eval {

/// How the commanded gait follows the one that the user's motion means.
class Agreement {
 public:
  using Table = std::array<std::array<std::uint64_t, stream::kGaits.size()>, stream::kGaits.size()>;

  /// One moment. The command agrees when it is what the motion has meant at some time within
  /// `delay_s`; `again` is what a command of the past may still stand for, besides.
  void Add(double time_s, stream::Gait meant, stream::Gait commanded, double delay_s,
           bool still_stands);
  /// Begins again, without what was meant before.
  void Restart() { meant_.clear(); }
  void Pool(const Agreement& other);

  std::uint64_t count() const { return count_; }
  double share() const {
    return count_ > 0 ? static_cast<double>(agree_) / static_cast<double>(count_) : 1;
  }
  /// Moments by the gait meant (row), once it has been meant for the delay, and the gait commanded.
  const Table& table() const { return table_; }

 private:
  struct Meant {
    double time_s = 0;  ///< From then on.
    stream::Gait gait = stream::Gait::kStep;
  };
  std::deque<Meant> meant_;
  std::uint64_t count_ = 0, agree_ = 0;
  Table table_{};
};

}  // namespace footing::eval
