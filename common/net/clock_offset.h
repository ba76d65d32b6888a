#pragma once

#include <cstdint>
#include <deque>

#include "common/net/client.h"

namespace footing::transport {

/// The four stamps of one Ping and its Pong: t0 and t3 on the asker's clock, t1 and t2 on the
/// answerer's.
struct Probe {
  std::int64_t t0_ns = 0;
  std::int64_t t1_ns = 0;
  std::int64_t t2_ns = 0;
  std::int64_t t3_ns = 0;
};

/// Estimated offset between two clocks, ns.
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

/// A client's pings and what they say of the server's clock. The first ones of a connection are
/// asked one after the other, before anything large is on its way: what waits behind a tick out of
/// the ring is answered late, and says little.
class ClockProbes {
 public:
  void OnWelcome(bool other_server) {
    if (other_server) estimator_ = {};
    answered_ = 0;
  }
  v1::Envelope Next(std::int64_t now_ns) { return MakePing(++id_, now_ns); }
  void Take(const v1::Pong& pong, std::int64_t arrived_ns) {
    if (pong.id() > id_) return;
    ++answered_;
    estimator_.Add({pong.t0_ns(), pong.t1_ns(), pong.t2_ns(), arrived_ns});
  }
  /// Enough are answered to begin.
  bool settled() const { return answered_ >= kFirst; }
  ClockOffset offset() const {
    const OffsetEstimate estimate = estimator_.estimate();
    return {estimate.valid, estimate.offset_ns, estimate.uncertainty_ns};
  }

 private:
  static constexpr int kFirst = 5;

  ClockOffsetEstimator estimator_;
  std::uint64_t id_ = 0;
  int answered_ = 0;
};

}  // namespace footing::transport
