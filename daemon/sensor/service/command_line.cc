#include "daemon/sensor/service/command_line.h"

#include <iostream>
#include <string>
#include <vector>

#include "common/cli/cli.h"
#include "common/log/log.h"

namespace footing::sensor {
namespace {

/// An option of its own goes before the file and --set.
template <typename Value>
void Override(const Value& given, const char* key, const char* option, Value& value,
              config::Binder& binder) {
  if (given.empty()) return;
  value = given;
  binder.SetOrigin(key, option);
}

}  // namespace

std::optional<CommandLine> ParseCommandLine(int argc, char** argv, int& exit_code) {
  CommandLine line;
  Config& config = line.config;
  config::Binder binder;
  config.Bind(binder);
  std::string file, metrics;
  std::vector<std::string> settings, listen, sources;
  bool print = false, origin = false, check = false, quiet = false, insecure_lan = false;
  auto app = cli::NewApp("footingd",
                         "Sensor daemon: reads devices, publishes samples, features and forces.",
                         "  footingd\n"
                         "  footingd --source stream:unix:/tmp/devices.sock\n"
                         "  footingd --set 'roles={\"00:1f:32:aa:bb:cc\": \"main/left_hand\"}'\n");
  app->add_option("--config", file, "Config file, JSON");
  app->add_option("--set", settings,
                  "Setting, key=value; may be repeated; overrides the config file");
  app->add_option(
      "--listen", listen,
      "Address for clients, unix:PATH, tcp:HOST:PORT or tls:HOST:PORT; may be repeated");
  app->add_option(
      "--source", sources,
      "Source of devices: hid, or stream:ADDRESS for simulated devices; may be repeated");
  app->add_option("--metrics", metrics, "Unix socket with metrics for Prometheus, unix:PATH");
  app->add_flag(
      "--insecure-lan", insecure_lan,
      "Allow --listen tcp: beyond this host WITHOUT ENCRYPTION; needs --set token_file=FILE");
  app->add_flag("--print-config", print, "Print the effective config and exit");
  app->add_flag(
      "--origin", origin,
      "With --print-config: where each value comes from, too (default, FILE:LINE, option)");
  app->add_flag("--check-config", check, "Check the config and exit");
  app->add_flag("--json", line.json, "Print the listening addresses as one JSON object");
  app->add_flag("-q,--quiet", quiet, "Log only warnings and errors");
  exit_code = 0;
  if (const auto code = cli::Parse(*app, argc, argv)) {
    exit_code = *code;
    return std::nullopt;
  }
  log::Start("footingd", quiet);
  auto done = binder.Apply(file, settings);
  Override(listen, "listen", "--listen", config.listen, binder);
  Override(sources, "sources", "--source", config.sources, binder);
  Override(metrics, "metrics", "--metrics", config.metrics, binder);
  if (insecure_lan) {
    config.access.insecure_lan = true;
    binder.SetOrigin("insecure_lan", "--insecure-lan");
  }
  if (done) done = Check(config);
  if (!done) {
    exit_code = cli::Report(done.error());
    return std::nullopt;
  }
  if (print) std::cout << (origin ? binder.PrintOrigins() : binder.Print()) << std::endl;
  if (print || check) return std::nullopt;
  return line;
}

}  // namespace footing::sensor
