#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <iostream>

#include "common/cli/cli.h"
#include "common/log/log.h"
#include "daemon/sensor/service/service.h"

namespace {

using namespace footing;  // NOLINT: main is wiring

/// Defaults < file < settings < flags of their own.
Result<void> Configure(config::Binder& binder, const std::string& file,
                       const std::vector<std::string>& settings) {
  if (!file.empty()) {
    if (const auto applied = binder.ApplyFile(file); !applied) return applied;
  }
  for (const std::string& setting : settings) {
    if (const auto applied = binder.ApplySetting(setting); !applied) return applied;
  }
  return {};
}

int Run(const sensor::Config& config) {
  boost::asio::io_context io(1);
  auto service = sensor::Service::Start(io, config, cli::Version());
  if (!service) return cli::Report(service.error());
  boost::asio::steady_timer farewell(io);  // Time for the goodbyes to leave.
  boost::asio::signal_set signals(io, SIGINT, SIGTERM);
  signals.async_wait([&](boost::system::error_code, int) {
    (*service)->Stop("footingd ends");
    farewell.expires_after(std::chrono::milliseconds(200));
    farewell.async_wait([&io](boost::system::error_code) { io.stop(); });
  });
  io.run();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  sensor::Config config;
  config::Binder binder;
  config.Bind(binder);
  std::string file;
  std::vector<std::string> settings, listen, sources;
  bool print = false, check = false, quiet = false;
  auto app = cli::NewApp("footingd", "Sensor daemon: device reports in, samples and features out.",
                         "  footingd\n"
                         "  footingd --source stream:unix:/tmp/devices.sock\n"
                         "  footingd --set 'roles={\"00:1f:32:aa:bb:cc\": \"main/left_hand\"}'\n");
  app->add_option("--config", file, "JSON file of settings");
  app->add_option("--set", settings, "One setting, key=value; may be repeated");
  app->add_option("--listen", listen, "unix:PATH or tcp:HOST:PORT; may be repeated");
  app->add_option("--source", sources, "hid or stream:ADDRESS; may be repeated");
  app->add_flag("--print-config", print, "Write the effective config and end");
  app->add_flag("--check-config", check, "Check the config and end");
  app->add_flag("-q,--quiet", quiet, "Log only warnings and errors");
  if (const auto code = cli::Parse(*app, argc, argv)) return *code;
  log::Start("footingd", quiet);

  if (const auto done = Configure(binder, file, settings); !done) return cli::Report(done.error());
  if (!listen.empty()) config.listen = listen;
  if (!sources.empty()) config.sources = sources;
  if (print) std::cout << binder.Print() << std::endl;
  if (print || check) return 0;
  return Run(config);
}
