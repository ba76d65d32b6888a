#pragma once

#include <cstdint>

#include "common/net/client.h"
#include "common/net/client_messages.h"
#include "common/net/clock_offset.h"

namespace footing::transport {

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
