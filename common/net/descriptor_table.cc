#include "common/net/descriptor_table.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>

namespace footing::transport {

void ReserveDescriptors(std::size_t count) {
  rlimit limit{};
  if (count == 0 || getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur == 0) return;
  const int any = open("/", O_PATH | O_CLOEXEC);
  if (any < 0) return;
  // The table never shrinks again.
  const auto last = static_cast<int>(std::min<rlim_t>(count, limit.rlim_cur) - 1);
  const int high = fcntl(any, F_DUPFD_CLOEXEC, last);
  if (high >= 0) close(high);
  close(any);
}

}  // namespace footing::transport
