#include <boost/asio/io_context.hpp>
#include <cstring>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "common/cli/cli.h"
#include "common/runtime/clock.h"
#include "common/runtime/log.h"
#include "common/runtime/service_manager.h"
#include "common/runtime/timer.h"
#include "daemon/sensor/service/config.h"
#include "daemon/sensor/service/service.h"

namespace {

using namespace footing;  // NOLINT: main is wiring

int Run(const sensor::CommandLine& line,
        const std::function<Result<sensor::Config>()>& read_again) {
  boost::asio::io_context io(1);
  auto service = sensor::Service::Start(io, line.config, cli::Version());
  if (!service) return cli::Report(service.error());
  service_manager::Notifier notifier(io, [&] { return (*service)->Stuck(); });
  service_manager::ServiceSignals::Handlers handlers;
  handlers.stop = [&](int signal, std::function<void()> done) {
    log::Info(std::string("stopped by SIG") + sigabbrev_np(signal));
    notifier.Stopping();
    (*service)->Stop(cli::StopReason("footingd", signal), std::move(done));
  };
  handlers.reload = [&] {
    const auto again = read_again();
    if (again) return (*service)->Reload(*again);
    log::Warning("config not reloaded: the one in force stays: " + again.error().message);
  };
  const service_manager::ServiceSignals signals(io, std::move(handlers));
  // Whoever reads this may send a signal at once.
  notifier.Ready("listening on " + (*service)->listening_on().front());
  if (line.json) {
    std::cout << nlohmann::json{{"listening_on", (*service)->listening_on()}} << std::endl;
  }
  timer::Run(io);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  int exit_code = 0;
  const auto line = sensor::ParseCommandLine(argc, argv, exit_code);
  if (!line) return exit_code;
  const auto followed = clock::FollowTimekeeper();
  if (!followed) return cli::Report(followed.error());
  return Run(*line, [&] { return sensor::ReadConfigAgain(argc, argv); });
}
