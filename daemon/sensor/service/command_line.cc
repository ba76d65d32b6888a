#include "daemon/sensor/service/command_line.h"

#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "common/cli/cli.h"
#include "common/runtime/log.h"
#include "daemon/sensor/service/server_options.h"

namespace footing::sensor {
namespace {

struct Given {
  std::string file, metrics;
  std::vector<std::string> settings, listen, sources;
  bool print = false, origin = false, check = false, json = false, quiet = false;
  bool insecure_lan = false;
};

std::unique_ptr<CLI::App> NewParser(Given& given) {
  auto app = cli::NewApp("footingd",
                         "Sensor daemon: reads devices, publishes samples, features and forces.",
                         "  footingd\n"
                         "  footingd --source stream:unix:/tmp/devices.sock\n"
                         "  footingd --set 'roles={\"00:1f:32:aa:bb:cc\": \"main/left_hand\"}'\n");
  app->add_option("--config", given.file, "Config file, JSON");
  app->add_option("--set", given.settings,
                  "Setting, key=value; may be repeated; overrides the config file");
  app->add_option(
      "--listen", given.listen,
      "Address for clients, unix:PATH, tcp:HOST:PORT or tls:HOST:PORT; may be repeated");
  app->add_option(
      "--source", given.sources,
      "Source of devices: hid, or stream:ADDRESS for simulated devices; may be repeated");
  app->add_option("--metrics", given.metrics,
                  "Address of the metrics for Prometheus, tcp:127.0.0.1:PORT or unix:PATH");
  app->add_flag(
      "--insecure-lan", given.insecure_lan,
      "Allow --listen tcp: beyond this host WITHOUT ENCRYPTION; needs --set token_file=FILE");
  CLI::Option* print =
      app->add_flag("--print-config", given.print, "Print the effective config and exit");
  app->add_flag(
         "--origin", given.origin,
         "With --print-config: where each value comes from, too (default, FILE:LINE, option)")
      ->needs(print);
  app->add_flag("--check-config", given.check,
                "Check the config and the files that it names, and exit");
  app->add_flag("--json", given.json, "Print the listening addresses as one JSON object");
  app->add_flag("-q,--quiet", given.quiet, "Log only warnings and errors");
  return app;
}

/// An option of its own goes before the file and --set.
template <typename Value>
void Override(const Value& given, const char* key, const char* option, Value& value,
              config::Binder& binder) {
  if (given.empty()) return;
  value = given;
  binder.SetOrigin(key, option);
}

/// `binder` is bound to `config`.
Result<void> Apply(const Given& given, Config& config, config::Binder& binder) {
  if (const auto done = binder.Apply(given.file, given.settings); !done) return done;
  Override(given.listen, "listen", "--listen", config.listen, binder);
  Override(given.sources, "sources", "--source", config.sources, binder);
  Override(given.metrics, "metrics", "--metrics", config.metrics, binder);
  if (given.insecure_lan) {
    config.access.insecure_lan = true;
    binder.SetOrigin("insecure_lan", "--insecure-lan");
  }
  return Check(config);
}

}  // namespace

std::optional<CommandLine> ParseCommandLine(int argc, char** argv, int& exit_code) {
  Given given;
  const auto app = NewParser(given);
  exit_code = 0;
  if (const auto code = cli::Parse(*app, argc, argv)) {
    exit_code = *code;
    return std::nullopt;
  }
  log::Start("footingd", given.quiet);
  CommandLine line;
  line.json = given.json;
  config::Binder binder;
  line.config.Bind(binder);
  auto done = Apply(given, line.config, binder);
  if (done && given.print) {
    std::cout << (given.origin ? binder.PrintOrigins() : binder.Print()) << std::endl;
  }
  if (done && given.check) done = CheckStart(line.config);
  if (!done) exit_code = cli::Report(done.error());
  if (!done || given.print || given.check) return std::nullopt;
  return line;
}

Result<Config> ReadConfigAgain(int argc, char** argv) {
  Given given;
  const auto app = NewParser(given);
  if (cli::Parse(*app, argc, argv)) return Failure("the command line cannot be read again");
  Config config;
  config::Binder binder;
  config.Bind(binder);
  if (const auto done = Apply(given, config, binder); !done) return done.error();
  return config;
}

}  // namespace footing::sensor
