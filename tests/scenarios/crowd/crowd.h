#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/net/address.h"
#include "tests/scenarios/crowd/reader.h"

namespace footing::crowd {

/// Ticks that the crowd got, of those that were made within a time.
struct Tally {
  std::uint64_t delivered = 0;  ///< Ticks, all viewers together.
  std::uint64_t expected = 0;   ///< Ticks that any viewer of an address got, times its viewers.
  std::uint64_t gaps = 0;       ///< Messages of that kind, whenever.
  std::uint64_t bytes = 0;
  double rate_hz = 0;  ///< Ticks a second that any viewer of the first address got.
  std::vector<double> lags_ms;
};

/// Thousands of viewers on one thread: each subscribes to everything, reads, and answers pings.
class Crowd {
 public:
  explicit Crowd(std::vector<transport::Address> addresses);
  ~Crowd();
  Crowd(const Crowd&) = delete;
  Crowd& operator=(const Crowd&) = delete;

  /// Viewers are spread over the addresses in turn. An error when one is not taken in.
  Result<void> Connect(std::size_t viewers);
  /// Reads until `end_ns`; counts ticks that were made from `from_ns` until `to_ns`.
  Result<void> Read(std::int64_t end_ns, std::int64_t from_ns, std::int64_t to_ns);
  Tally tally() const;

 private:
  struct Viewer {
    int socket = -1;
    std::size_t address = 0;
    bool subscribed = false;
    FrameReader frames;
  };

  Result<void> Add(std::size_t address);
  /// Reads what is there now, for at most this long.
  Result<void> Poll(int timeout_ms);
  Result<void> ReadSome(Viewer& viewer);
  void OnTick(const Viewer& viewer, const TickHead& tick);

  std::vector<transport::Address> addresses_;
  int epoll_;
  std::vector<Viewer> viewers_;
  std::size_t subscribed_ = 0;
  std::int64_t from_ns_ = 0, to_ns_ = 0;
  std::vector<std::set<std::uint64_t>> sequences_;  ///< Sequences at each address.
  Tally tally_;
};

}  // namespace footing::crowd
