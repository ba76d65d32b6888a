#pragma once

#include <cstdint>

namespace footing::monitoring {

/// What this process takes of the host.
struct ProcessUsage {
  double cpu_s = 0;  ///< User and system.
  std::uint64_t resident_bytes = 0;
  std::uint64_t open_descriptors = 0;
};

/// From getrusage(2) and /proc/self; what is not to be had there is 0.
ProcessUsage UsageOfThisProcess();

}  // namespace footing::monitoring
