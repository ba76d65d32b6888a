#include "clients/relay/options.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <optional>
#include <utility>

#include <unistd.h>

#include "clients/relay/login.h"
#include "common/net/monitoring.h"
#include "common/runtime/service_manager.h"
#include "common/runtime/timer.h"

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
  timer::Timer patience(io);
  std::optional<RunEnd> ended;
  const auto stop = [&](RunEnd why) {
    if (ended) return;
    ended = why;
    patience.After(std::chrono::seconds(2), [&] { io.stop(); });
    end([&io] { io.stop(); });
  };
  service_manager::ProgramEnd program(io, [&] { stop(RunEnd::kStopped); });
  program.After(seconds, [&] { stop(RunEnd::kTimeUp); });
  io.run();
  return ended.value_or(RunEnd::kStopped);
}

namespace {

using monitoring::Braced;
using monitoring::MetricsWriter;

std::uint64_t Number(bool value) { return value ? 1 : 0; }

void WriteTicks(std::uint64_t ticks, std::uint64_t missing, MetricsWriter& to) {
  to.Counter("footing_relay_ticks_total", "Ticks received.");
  to.Sample(ticks);
  to.Counter("footing_relay_ticks_missing_total", "Ticks that never arrived; viewers get a Gap.");
  to.Sample(missing);
}

void BeginBrokers(MetricsWriter& to) {
  to.Gauge("footing_relay_broker_up", "1 while the broker is connected.");
}

}  // namespace

std::string MetricsText(const PublisherReport& report, const std::string& version) {
  MetricsWriter to;
  monitoring::WriteProgram({"footing-relay", version}, to);
  WriteTicks(report.ticks, report.missing, to);
  to.Gauge("footing_relay_source_up", "1 while the server is connected.");
  for (const PublisherReport::SourceState& source : report.sources) {
    to.Sample(Number(source.up), Braced({{"address", source.address}, {"server", source.server}}));
  }
  BeginBrokers(to);
  if (report.nats_up) to.Sample(Number(*report.nats_up), Braced({{"broker", "nats"}}));
  if (report.mqtt_up) to.Sample(Number(*report.mqtt_up), Braced({{"broker", "mqtt"}}));
  to.Counter("footing_relay_published_total", "Messages published.");
  to.Sample(report.published);
  to.Counter("footing_relay_dropped_total",
             "Messages that a broker did not take, since it was gone or slow.");
  to.Sample(report.dropped);
  monitoring::WriteProcess(monitoring::UsageOfThisProcess(), to);
  return to.Take();
}

std::string MetricsText(const EdgeReport& report, const std::string& version) {
  MetricsWriter to;
  monitoring::WriteProgram({"footing-relay", version}, to);
  WriteTicks(report.ticks, report.missing, to);
  BeginBrokers(to);
  to.Sample(Number(report.nats_up), Braced({{"broker", "nats"}}));
  to.Gauge("footing_relay_serving", "1 while viewers can connect.");
  to.Sample(Number(report.serving));
  to.Counter("footing_relay_ticks_left_out_total", "Ticks left out because of --rate-hz.");
  to.Sample(report.left_out);
  to.Gauge("footing_sessions", "Current sessions.");
  to.Sample(report.sessions);
  to.Counter("footing_connections_accepted_total", "Connections accepted.");
  to.Sample(report.accepted);
  to.Counter("footing_ticks_dropped_total", "Ticks dropped because a session's queue was full.");
  to.Sample(report.dropped);
  monitoring::WriteProcess(monitoring::UsageOfThisProcess(), to);
  return to.Take();
}

}  // namespace footing::relay
