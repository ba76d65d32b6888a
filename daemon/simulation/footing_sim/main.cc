#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <iostream>

#include "common/cli/cli.h"
#include "common/log/log.h"
#include "daemon/simulation/footing_sim/service.h"

namespace {

using namespace footing;  // NOLINT: main is wiring

int Run(const serving::Config& config) {
  boost::asio::io_context io(1);
  auto service = footing_sim::Service::Start(io, config, cli::Version());
  if (!service) return cli::Report(service.error());
  boost::asio::steady_timer farewell(io);  // Time for the goodbyes to leave.
  boost::asio::signal_set signals(io, SIGINT, SIGTERM);
  signals.async_wait([&](boost::system::error_code, int) {
    (*service)->Stop("footing-sim ends");
    farewell.expires_after(std::chrono::milliseconds(200));
    farewell.async_wait([&io](boost::system::error_code) { io.stop(); });
  });
  io.run();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  serving::Config config;
  config::Binder binder;
  config.Bind(binder);
  std::string file;
  std::vector<std::string> settings, listen;
  std::string engine, sensor, interface, track, subject, mode;
  std::int64_t lag_ms = -1;
  bool print = false, check = false, quiet = false;
  auto app = cli::NewApp(
      "footing-sim",
      "Simulation server: drives a walking biped by features, or reconstructs a body from boards.",
      "  footing-sim\n  footing-sim --sensor tcp:127.0.0.1:7710 --track straight\n"
      "  footing-sim --engine pose --subject p07.json --lag-ms 100\n");
  app->add_option("--config", file, "Config file, JSON");
  app->add_option("--set", settings,
                  "Setting, key=value; may be repeated; overrides the config file");
  app->add_option("--listen", listen,
                  "Address for clients, unix:PATH or tcp:HOST:PORT; may be repeated");
  app->add_option("--engine", engine, "Engine: gait or pose");
  app->add_option("--sensor", sensor, "Address of footingd");
  app->add_option("--interface", interface, "User interface: wrist (gait engine)");
  app->add_option("--track", track, "Track: a built-in name, or a JSON file (gait engine)");
  app->add_option("--subject", subject, "Subject file, JSON (pose engine)");
  app->add_option("--mode", mode, "Reconstruction mode: best or paper (pose engine)");
  app->add_option(
      "--lag-ms", lag_ms,
      "Output delay of the pose engine, ms: 0, 100 or 200; longer is more accurate (default: 0)");
  app->add_flag("--print-config", print, "Print the effective config and exit");
  app->add_flag("--check-config", check, "Check the config and exit");
  app->add_flag("-q,--quiet", quiet, "Log only warnings and errors");
  if (const auto code = cli::Parse(*app, argc, argv)) return *code;
  log::Start("footing-sim", quiet);

  if (const auto done = binder.Apply(file, settings); !done) return cli::Report(done.error());
  if (!listen.empty()) config.listen = listen;
  if (!engine.empty()) config.engine = engine;
  if (!sensor.empty()) config.sensor = sensor;
  if (!interface.empty()) config.interface = interface;
  if (!track.empty()) config.track = track;
  if (!subject.empty()) config.subject = subject;
  if (!mode.empty()) config.mode = mode;
  if (lag_ms >= 0) config.lag_ms = lag_ms;
  if (const auto built = serving::CheckBuilt(config); !built) return cli::Report(built.error());
  if (print) std::cout << binder.Print() << std::endl;
  if (print || check) return 0;
  return Run(config);
}
