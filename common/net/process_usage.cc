#include "common/net/process_usage.h"

#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

namespace footing::monitoring {
namespace {

double Seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

ProcessUsage UsageOfThisProcess() {
  ProcessUsage usage;
  rusage used{};
  if (getrusage(RUSAGE_SELF, &used) == 0) {
    usage.cpu_s = Seconds(used.ru_utime) + Seconds(used.ru_stime);
  }
  std::ifstream pages("/proc/self/statm");  // Total and resident, in pages.
  std::uint64_t total = 0, resident = 0;
  if (pages >> total >> resident) {
    usage.resident_bytes = resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  }
  std::error_code error;
  const std::filesystem::directory_iterator descriptors("/proc/self/fd", error);
  if (!error) {
    const auto listed = std::distance(begin(descriptors), end(descriptors));
    usage.open_descriptors = static_cast<std::uint64_t>(listed - 1);  // Without the listing's own.
  }
  return usage;
}

}  // namespace footing::monitoring
