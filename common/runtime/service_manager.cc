#include "common/runtime/service_manager.h"

#include <systemd/sd-daemon.h>

#include <cstdint>
#include <cstdlib>

#include "common/runtime/log.h"

namespace footing::service_manager {

int PassedSocket(const std::string& name) {
  char** names = nullptr;
  const int count = sd_listen_fds_with_names(0, &names);
  int found = -1;
  for (int i = 0; i < count; ++i) {
    if (found < 0 && name == names[i]) found = SD_LISTEN_FDS_START + i;
    std::free(names[i]);  // The library gives strings of malloc.
  }
  std::free(names);
  return found;
}

void Notifier::Ready(const std::string& status) {
  status_ = status;
  sd_notify(0, ("READY=1\nSTATUS=" + status).c_str());
  std::uint64_t interval_us = 0;
  if (sd_watchdog_enabled(0, &interval_us) <= 0) return;
  interval_ = std::chrono::microseconds(interval_us / 2);
  Beat();
}

/// A stuck thread ends the program: by the service manager, when it has missed this for long
/// enough.
void Notifier::Report() {
  const std::string stuck = what_is_stuck_();
  if (stuck != stuck_) {
    if (!stuck.empty()) log::Error(stuck + " is stuck: the watchdog is not fed until it goes on");
    if (stuck.empty()) log::Warning(stuck_ + " goes on");
    sd_notify(0, ("STATUS=" + (stuck.empty() ? status_ : stuck + " is stuck")).c_str());
    stuck_ = stuck;
  }
  if (stuck.empty()) sd_notify(0, "WATCHDOG=1");
}

void Notifier::Beat() {
  Report();
  timer_.expires_after(interval_);
  timer_.async_wait([this](boost::system::error_code error) {
    if (!error) Beat();
  });
}

void Notifier::Stopping() {
  timer_.cancel();
  sd_notify(0, "STOPPING=1");
}

}  // namespace footing::service_manager
