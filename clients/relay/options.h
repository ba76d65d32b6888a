#pragma once

#include <functional>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <boost/asio/io_context.hpp>

#include "clients/relay/edge.h"
#include "clients/relay/nats_link.h"
#include "clients/relay/publisher.h"
#include "common/base/result.h"
#include "common/net/metrics_endpoint.h"

/// Options that both subcommands have, and how both run.
namespace footing::relay {

/// Flags common to both subcommands.
struct SiteFlags {
  std::string site;
  double seconds = 0;
  std::string metrics;  ///< Address of the endpoint for Prometheus; empty: none.

  void Add(CLI::App& command);
  /// The site, or this host's name where none was given.
  Result<std::string> Site() const;
};

/// The link to NATS of these flags.
Result<NatsOptions> NatsOf(const std::string& address, const std::string& login_file);

/// Serves metrics where the flags say so; nothing where they do not.
Result<std::unique_ptr<monitoring::MetricsEndpoint>> ServeMetrics(
    boost::asio::io_context& io, const SiteFlags& flags, std::function<std::string()> text);

/// Why a run has ended.
enum class RunEnd { kStopped, kTimeUp };

/// Runs the loop until SIGINT, SIGTERM or the time is up. Then `end` is called once, with what
/// stops the loop when its work is done; it is stopped after 2 s in any case.
RunEnd RunUntilStopped(boost::asio::io_context& io, double seconds,
                       const std::function<void(std::function<void()> done)>& end);

/// How a relay fares, in Prometheus' text format, with what this process takes of the host.
std::string MetricsText(const PublisherReport& report, const std::string& version);
std::string MetricsText(const EdgeReport& report, const std::string& version);

/// Options and exit code common to both subcommands.
struct Shared {
  bool json = false;
  int exit_code = 0;
};

/// Each adds one subcommand to footing-relay; its callback does the work.
void AddPublishCommand(CLI::App& app, Shared& shared);
void AddServeCommand(CLI::App& app, Shared& shared);

}  // namespace footing::relay
