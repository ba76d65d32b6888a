#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/net/address.h"

namespace footing::log_client {

struct RecordOptions {
  std::vector<transport::Address> addresses;
  std::string out;
  double seconds = 0;      ///< From the start; 0: until SIGINT or SIGTERM.
  bool from_ring = false;  ///< First what the servers' rings still hold, up to 30 s.
  bool replace = false;
  std::vector<std::string> attachments;  ///< Files: config, calibrations, track, survey.
  std::string version;
};

struct RecordReport {
  std::uint64_t messages = 0;
  std::uint64_t ticks = 0;
  std::uint64_t missing_ticks = 0;
  double duration_s = 0;  ///< Between the first and the last message.
};

/// Records until the time is up or SIGINT or SIGTERM comes, then ends the file properly. Progress
/// goes to standard error. A recording into which nothing came is a failure that says what was
/// waited for, and leaves no file, or the existing one as it was; a disk that is full is a failure,
/// and the file stays repairable.
Result<RecordReport> Record(const RecordOptions& options);

}  // namespace footing::log_client
