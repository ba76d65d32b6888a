#include <boost/asio/io_context.hpp>
#include <memory>

#include "common/cli/cli.h"
#include "common/cli/server.h"
#include "daemon/sensor/service/config.h"
#include "daemon/sensor/service/service.h"

int main(int argc, char** argv) {
  using namespace footing;  // NOLINT: main is wiring
  cli::ServerLine line;
  if (const auto code = cli::ParseServerLine(sensor::Program(), argc, argv, line)) return *code;
  const auto config = sensor::ReadConfig(line);
  if (!config) return cli::Report(config.error());
  if (line.print || line.check) return 0;
  return cli::RunServer(line, [&](boost::asio::io_context& io) -> Result<cli::RunningServer> {
    auto started = sensor::Service::Start(io, *config, cli::Version());
    if (!started) return started.error();
    const std::shared_ptr<sensor::Service> service = std::move(*started);
    return cli::RunningServer{
        .status = "listening on " + service->listening_on().front(),
        .listening_on = service->listening_on(),
        .stuck = [service] { return service->Stuck(); },
        .stop = [service](const std::string& reason,
                          std::function<void()> done) { service->Stop(reason, std::move(done)); },
        .reload = [service, &line]() -> Result<void> {
          const auto wanted = sensor::ReadConfig(line);
          return wanted ? service->Reload(*wanted) : wanted.error();
        }};
  });
}
