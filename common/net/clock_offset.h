#pragma once

#include <cstdint>
#include <deque>

namespace footing::transport {

/// The four stamps of one Ping and its Pong: t0 and t3 on the asker's clock, t1 and t2 on the
/// answerer's.
struct Probe {
  std::int64_t t0_ns = 0;
  std::int64_t t1_ns = 0;
  std::int64_t t2_ns = 0;
  std::int64_t t3_ns = 0;
};

struct OffsetEstimate {
  bool valid = false;
  std::int64_t offset_ns = 0;       ///< The answerer's clock minus the asker's.
  std::int64_t uncertainty_ns = 0;  ///< The truth is within, while the clocks do not drift apart.
};

/// The offset between two clocks out of pings, as in RFC 5905, section 8, with the minimum filter
/// of its section 10: of the last 8 probes the one with the shortest round trip counts, since its
/// two ways differ least. Its error is at most half its round trip.
///
/// The first 8 probes are taken at once. From then on the estimate moves towards a better one by at
/// most 0.5 ms a second of the asker's clock, so that mapped stamps do not jump; what is still to
/// go is part of the uncertainty. One that contradicts the current one beyond both uncertainties is
/// taken at once.
class ClockOffsetEstimator {
 public:
  static constexpr std::size_t kProbes = 8;
  static constexpr double kMaxSlew = 5e-4;

  /// A probe with t3 < t0, a negative round trip, a stamp outside [0, 2^61) ns, or without t1 or t2
  /// is ignored.
  void Add(const Probe& probe);
  OffsetEstimate estimate() const { return estimate_; }

 private:
  struct Sample {
    std::int64_t offset_ns = 0;
    std::int64_t round_trip_ns = 0;
  };
  void Approach(const Sample& best, std::int64_t now_ns);

  std::deque<Sample> samples_;
  bool settled_ = false;  ///< There were 8 probes.
  OffsetEstimate estimate_;
  std::int64_t moved_ns_ = 0;  ///< When the estimate last moved, asker's clock.
};

}  // namespace footing::transport
