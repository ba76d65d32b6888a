#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

namespace footing::transport {

/// Which server a client is connected to, and what a new connection resumes.
struct ServerPosition {
  std::string name;
  std::uint64_t epoch = 0;
  /// Of the last tick, which may be of an epoch before: the connection may break between.
  std::uint64_t last_epoch = 0;
  std::uint64_t last_sequence = 0;

  /// A live tick has come.
  void Take(std::uint64_t sequence) {
    last_sequence = last_epoch == epoch ? std::max(last_sequence, sequence) : sequence;
    last_epoch = epoch;
  }
};

}  // namespace footing::transport
