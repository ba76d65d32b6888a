#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <chrono>
#include <iostream>
#include <nlohmann/json.hpp>

#include "common/cli/cli.h"
#include "common/clock/clock.h"
#include "common/service_manager/service_manager.h"
#include "common/timer/timer.h"
#include "daemon/sensor/service/command_line.h"
#include "daemon/sensor/service/service.h"

namespace {

using namespace footing;  // NOLINT: main is wiring

int Run(const sensor::CommandLine& line) {
  boost::asio::io_context io(1);
  boost::asio::signal_set signals(io, SIGINT, SIGTERM);
  auto service = sensor::Service::Start(io, line.config, cli::Version());
  if (!service) return cli::Report(service.error());
  if (line.json) {
    std::cout << nlohmann::json{{"listening_on", (*service)->listening_on()}} << std::endl;
  }
  service_manager::Notifier notifier(io);
  notifier.Ready("listening on " + (*service)->listening_on().front());
  timer::Timer goodbye(io);  // Time for the goodbyes to leave.
  signals.async_wait([&](boost::system::error_code, int) {
    notifier.Stopping();
    (*service)->Stop("footingd ends");
    goodbye.expires_after(std::chrono::milliseconds(200));
    goodbye.async_wait([&io](boost::system::error_code) { io.stop(); });
  });
  timer::Run(io);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  int exit_code = 0;
  const auto line = sensor::ParseCommandLine(argc, argv, exit_code);
  if (!line) return exit_code;
  const auto followed = clock::FollowTimekeeper();
  return followed ? Run(*line) : cli::Report(followed.error());
}
