#include "common/runtime/service_manager.h"

#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <utility>

#include <fcntl.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

#include "common/runtime/clock.h"
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
  timer_.After(interval_, [this] { Beat(); });
}

void Notifier::Stopping() {
  timer_.cancel();
  sd_notify(0, "STOPPING=1");
}

namespace {

/// Below the 90 s of TimeoutStopSec=, and below what a person waits for at a terminal.
constexpr auto kPatience = std::chrono::seconds(2);

/// Whether this process still has a controlling terminal: it loses it when that is closed.
bool HasTerminal() {
  const int terminal = open("/dev/tty", O_RDONLY | O_NOCTTY | O_CLOEXEC);
  if (terminal >= 0) close(terminal);
  return terminal >= 0;
}

/// Asked before SIGHUP gets a handler.
bool EndsWithTerminal() {
  struct sigaction hang_up {};
  sigaction(SIGHUP, nullptr, &hang_up);
  const bool under_nohup = hang_up.sa_handler == SIG_IGN;
  return !under_nohup && HasTerminal();
}

}  // namespace

ServiceSignals::ServiceSignals(boost::asio::io_context& io, Handlers handlers)
    : io_(io),
      signals_(io),
      patience_(io),
      handlers_(std::move(handlers)),
      ends_with_terminal_(EndsWithTerminal()) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) signals_.add(signal);
  Wait();
}

void ServiceSignals::Wait() {
  signals_.async_wait([this](const boost::system::error_code& error, int signal) {
    if (error) return;
    OnSignal(signal);
    Wait();
  });
}

void ServiceSignals::OnSignal(int signal) {
  if (signal == SIGHUP && !(ends_with_terminal_ && !HasTerminal())) {
    if (stopping_) return;
    const std::string now_us = std::to_string(clock::MonotonicNs() / 1000);
    sd_notify(0, ("RELOADING=1\nMONOTONIC_USEC=" + now_us).c_str());
    handlers_.reload();
    sd_notify(0, "READY=1");
    return;
  }
  if (std::exchange(stopping_, true)) return io_.stop();
  patience_.After(kPatience, [this] { io_.stop(); });
  handlers_.stop(signal, [this] { io_.stop(); });
}

ProgramEnd::ProgramEnd(boost::asio::io_context& io, std::function<void()> on_signal)
    : signals_(io, SIGINT, SIGTERM), limit_(io) {
  signals_.async_wait(
      [this, on_signal = std::move(on_signal)](const boost::system::error_code& error, int) {
        if (error) return;
        asked_ = true;
        if (on_signal) on_signal();
      });
}

void ProgramEnd::After(double seconds, std::function<void()> on_time_up) {
  limit_.cancel();
  if (seconds > 0) limit_.After(seconds, std::move(on_time_up));
}

void ProgramEnd::cancel() {
  signals_.cancel();
  limit_.cancel();
}

}  // namespace footing::service_manager
