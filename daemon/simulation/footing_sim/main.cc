#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <chrono>

#include "common/cli/cli.h"
#include "common/clock/clock.h"
#include "common/service_manager/service_manager.h"
#include "common/timer/timer.h"
#include "daemon/simulation/footing_sim/command_line.h"
#include "daemon/simulation/footing_sim/service.h"

int main(int argc, char** argv) {
  using namespace footing;  // NOLINT: main is wiring
  footing_sim::Config config;
  if (const auto code = footing_sim::ReadCommandLine(argc, argv, config)) return *code;
  if (const auto done = clock::FollowTimekeeper(); !done) return cli::Report(done.error());
  boost::asio::io_context io(1);
  const auto stop = footing_sim::StartService(io, config, cli::Version());
  if (!stop) return cli::Report(stop.error());
  service_manager::Notifier notifier(io);
  notifier.Ready("engine " + config.engine);
  timer::Timer goodbye(io);  // Time for the goodbyes to leave.
  boost::asio::signal_set signals(io, SIGINT, SIGTERM);
  signals.async_wait([&](boost::system::error_code, int) {
    notifier.Stopping();
    (*stop)("footing-sim ends");
    goodbye.expires_after(std::chrono::milliseconds(200));
    goodbye.async_wait([&io](boost::system::error_code) { io.stop(); });
  });
  timer::Run(io);
  return 0;
}
