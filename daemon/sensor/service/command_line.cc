#include "daemon/sensor/service/command_line.h"

#include <iostream>
#include <string>
#include <vector>

#include "common/cli/cli.h"
#include "common/log/log.h"

namespace footing::sensor {
std::optional<CommandLine> ParseCommandLine(int argc, char** argv, int& exit_code) {
  CommandLine line;
  Config& config = line.config;
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
  app->add_flag("--json", line.json, "Say where it listens as one JSON object");
  app->add_flag("-q,--quiet", quiet, "Log only warnings and errors");
  exit_code = 0;
  if (const auto code = cli::Parse(*app, argc, argv)) {
    exit_code = *code;
    return std::nullopt;
  }
  log::Start("footingd", quiet);
  auto done = binder.Apply(file, settings);
  if (!listen.empty()) config.listen = listen;
  if (!sources.empty()) config.sources = sources;
  if (done) done = Check(config);
  if (!done) {
    exit_code = cli::Report(done.error());
    return std::nullopt;
  }
  if (print) std::cout << binder.Print() << std::endl;
  if (print || check) return std::nullopt;
  return line;
}

}  // namespace footing::sensor
