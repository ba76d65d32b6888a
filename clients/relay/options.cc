#include "clients/relay/options.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <csignal>
#include <optional>
#include <utility>

#include "clients/relay/broker_address.h"
#include "clients/relay/login_file.h"

namespace footing::relay {

void SiteFlags::Add(CLI::App& command) {
  command.add_option("--site", site,
                     "Name of the site, letters, digits, - and _ (default: this host's name)");
  command.add_option("--seconds", seconds, "Duration, s (0: until SIGINT or SIGTERM)")
      ->check(CLI::Range(0.0, 1e9));
  command.add_option(
      "--metrics", metrics,
      "Address of the metrics for Prometheus, tcp:127.0.0.1:PORT or unix:PATH (default: none)");
}

Result<std::string> SiteFlags::Site() const {
  std::string name = site;
  if (name.empty()) {
    std::array<char, 65> host{};
    gethostname(host.data(), host.size() - 1);
    name = std::string(host.data());
    std::replace(name.begin(), name.end(), '.', '_');
  }
  if (!nats::IsPart(name)) {
    return UsageError("--site: \"" + name + "\" must be 1 to 64 letters, digits, - and _");
  }
  return name;
}

Result<NatsOptions> NatsOf(const std::string& address, const std::string& login_file) {
  const auto at = ParseBrokerAddress(
      address, "run a nats-server on this host as a leaf node of that one (docs/scale.md)");
  if (!at) return at.error();
  auto login = ReadLoginFile(login_file);
  if (!login) return login.error();
  NatsOptions options;
  options.address = *at;
  options.client_name = "footing-relay";
  options.login = std::move(login).value();
  return options;
}

Result<std::unique_ptr<monitoring::MetricsEndpoint>> ServeMetrics(
    boost::asio::io_context& io, const SiteFlags& flags, std::function<std::string()> text) {
  if (flags.metrics.empty()) return std::unique_ptr<monitoring::MetricsEndpoint>();
  return monitoring::MetricsEndpoint::Open(io, flags.metrics, std::move(text));
}

RunEnd RunUntilStopped(boost::asio::io_context& io, double seconds,
                       const std::function<void(std::function<void()>)>& end) {
  boost::asio::signal_set signals(io, SIGINT, SIGTERM);
  boost::asio::steady_timer timer(io);
  std::optional<RunEnd> ended;
  const auto stop = [&](const boost::system::error_code& error, RunEnd why) {
    if (error || ended) return;
    ended = why;
    timer.expires_after(std::chrono::seconds(2));
    timer.async_wait([&](const boost::system::error_code&) { io.stop(); });
    end([&io] { io.stop(); });
  };
  signals.async_wait(
      [&](const boost::system::error_code& error, int) { stop(error, RunEnd::kStopped); });
  if (seconds > 0) {
    timer.expires_after(std::chrono::duration_cast<std::chrono::nanoseconds>(
        std::chrono::duration<double>(seconds)));
    timer.async_wait([&](const boost::system::error_code& error) { stop(error, RunEnd::kTimeUp); });
  }
  io.run();
  return ended.value_or(RunEnd::kStopped);
}

}  // namespace footing::relay
