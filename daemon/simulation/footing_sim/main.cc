#include <boost/asio/io_context.hpp>

#include "common/cli/cli.h"
#include "common/cli/server.h"
#include "daemon/simulation/footing_sim/command_line.h"

int main(int argc, char** argv) {
  using namespace footing;  // NOLINT: main is wiring
  if (const auto code = footing_sim::RunExport(argc, argv)) return *code;
  cli::ServerLine line;
  if (const auto code = cli::ParseServerLine(footing_sim::Program(), argc, argv, line))
    return *code;
  const auto config = footing_sim::ReadConfig(line);
  if (!config) return cli::Report(config.error());
  if (line.print || line.check) return 0;
  return cli::RunServer(line, [&](boost::asio::io_context& io) {
    return footing_sim::StartService(io, line, *config, cli::Version());
  });
}
