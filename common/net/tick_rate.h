#pragma once

#include "footing/v1/session.pb.h"

namespace footing::transport {

/// Whether a server can have this rate; one from another program or a file may be anything.
constexpr bool IsTickRate(double rate_hz) { return rate_hz >= 0.1 && rate_hz <= 10'000; }

/// The rate of the server that says this; `otherwise` where it says none, or none that can be.
inline double TickRateOf(const v1::Welcome& welcome, double otherwise) {
  const double rate_hz = welcome.limits().tick_rate_hz();
  return IsTickRate(rate_hz) ? rate_hz : otherwise;
}

}  // namespace footing::transport
