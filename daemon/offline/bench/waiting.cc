#include "daemon/offline/bench/waiting.h"

#include <unistd.h>

#include <fstream>

#include "common/runtime/clock.h"

namespace footing::bench {

transport::Address UnixAddress(const std::string& name) {
  transport::Address address;
  address.path = "/tmp/footing-bench-" + std::to_string(getpid()) + "-" + name;
  return address;
}

transport::Address TcpAddress() {
  transport::Address address;
  address.kind = transport::Address::Kind::kTcp;
  address.host = "127.0.0.1";
  return address;
}

bool WaitUntil(LoopThread& thread, const std::function<bool()>& condition) {
  constexpr int kTries = 1000;
  constexpr std::int64_t kPauseNs = 5'000'000;
  for (int i = 0; i < kTries; ++i) {
    bool holds = false;
    thread.Do([&] { holds = condition(); });
    if (holds) return true;
    clock::SleepUntil(clock::MonotonicNs() + kPauseNs);
  }
  return false;
}

double ResidentMegabytes() {
  std::ifstream file("/proc/self/statm");
  double total_pages = 0;
  double resident_pages = 0;
  file >> total_pages >> resident_pages;
  return resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE)) * 1e-6;
}

}  // namespace footing::bench
