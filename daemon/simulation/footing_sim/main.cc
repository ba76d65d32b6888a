#include <boost/asio/io_context.hpp>
#include <cstring>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "common/cli/cli.h"
#include "common/runtime/clock.h"
#include "common/runtime/log.h"
#include "common/runtime/service_manager.h"
#include "common/runtime/timer.h"
#include "daemon/simulation/footing_sim/command_line.h"

int main(int argc, char** argv) {
  using namespace footing;  // NOLINT: main is wiring
  footing_sim::CommandLine line;
  if (const auto code = footing_sim::ReadCommandLine(argc, argv, line)) return *code;
  footing_sim::Config& config = line.config;
  if (const auto done = clock::FollowTimekeeper(); !done) return cli::Report(done.error());
  boost::asio::io_context io(1);
  const auto served = footing_sim::StartService(io, config, cli::Version());
  if (!served) return cli::Report(served.error());
  service_manager::Notifier notifier(io, served->stuck);
  service_manager::ServiceSignals::Handlers handlers;
  handlers.stop = [&](int signal, std::function<void()> done) {
    log::Info(std::string("stopped by SIG") + sigabbrev_np(signal));
    notifier.Stopping();
    served->stop(cli::StopReason("footing-sim", signal), std::move(done));
  };
  handlers.reload = [&] {
    const auto keep = [](const Error& error) {
      log::Warning("config not reloaded: the one in force stays: " + error.message);
    };
    const auto wanted = footing_sim::ReadConfigAgain(argc, argv);
    if (!wanted) return keep(wanted.error());
    const auto changed_files = served->reload(wanted->serving);
    if (!changed_files) return keep(changed_files.error());
    config = footing_sim::Reloaded(config, *wanted, *changed_files, log::Info);
  };
  const service_manager::ServiceSignals signals(io, std::move(handlers));
  // Whoever reads this may send a signal at once.
  notifier.Ready("engine " + config.engine);
  if (line.json) {
    std::cout << nlohmann::json{{"listening_on", served->listening_on}} << std::endl;
  }
  timer::Run(io);
  return 0;
}
