#include "common/runtime/service_signals.h"

#include <fcntl.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <string>
#include <utility>

#include "common/runtime/clock.h"

namespace footing::service_manager {
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
  patience_.expires_after(kPatience);
  patience_.async_wait([this](const boost::system::error_code& error) {
    if (!error) io_.stop();
  });
  handlers_.stop(signal, [this] { io_.stop(); });
}

}  // namespace footing::service_manager
