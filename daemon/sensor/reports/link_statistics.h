#pragma once

#include <cstdint>

namespace footing::link {

/// How a device's data reports arrive: rate, jitter, gaps. Rate and jitter are exponential means
/// over about one second.
class LinkStatistics {
 public:
  /// `nominal_period_s`: a longer interval than five of these is a gap.
  explicit LinkStatistics(double nominal_period_s) : nominal_period_s_(nominal_period_s) {}

  void Advance(std::int64_t received_ns);

  /// 0 when nothing came for `now_ns` - one second.
  double RateHz(std::int64_t now_ns) const;
  double JitterMs() const;
  std::uint64_t reports() const { return reports_; }
  std::uint64_t gaps() const { return gaps_; }
  std::int64_t last_ns() const { return last_ns_; }

 private:
  double nominal_period_s_;
  std::uint64_t reports_ = 0;
  std::uint64_t gaps_ = 0;
  std::int64_t last_ns_ = 0;
  double mean_s_ = 0;
  double variance_s2_ = 0;
};

}  // namespace footing::link
