#include "daemon/simulation/footing_sim/command_line.h"

#include <array>
#include <iostream>

#include "common/cli/cli.h"
#include "common/net/address.h"
#include "common/net/metrics_endpoint.h"
#include "common/runtime/config.h"
#include "common/runtime/log.h"
#include "daemon/simulation/gait_service/gait_run.h"
#include "daemon/simulation/pose_service/pose_line.h"

namespace footing::footing_sim {

void Config::Bind(config::Binder& binder) {
  binder.Text("engine", engine,
              "Engine: gait (a walking biped) or pose (a body reconstructed over two boards)");
  serving.Bind(binder);
  gait.Bind(binder);
  pose.Bind(binder);
}

Result<void> Check(const Config& config) {
  if (config.engine != "gait" && config.engine != "pose") {
    return UsageError("unknown --engine " + config.engine + "; there are: gait, pose");
  }
  const auto sensor = transport::AddressOrDefault(config.serving.sensor, "sensor");
  if (!sensor) return UsageError("--sensor: " + sensor.error().message);
  if (!config.serving.metrics.empty()) {
    const auto metrics = monitoring::MetricsEndpoint::Check(config.serving.metrics);
    if (!metrics) return metrics;
  }
  if (const auto checked = gait_service::Check(config.gait); !checked) return checked;
  return pose_service::Check(config.pose);
}

Result<void> CheckApply(const Config& config, const std::vector<std::string>& settings) {
  const bool pose = config.engine == "pose";
  config::Binder others;  // Has the keys of the engine that does not run.
  gait_service::Config gait;
  pose_service::Config body;
  if (pose) {
    gait.Bind(others);
  } else {
    body.Bind(others);
  }
  for (const std::string& setting : settings) {
    const std::string key = setting.substr(0, setting.find('='));
    if (!others.Has(key)) continue;
    return UsageError(key + " does not apply to --engine " + config.engine +
                      ": it is a setting of --engine " + (pose ? "gait" : "pose") +
                      "; leave it out, or choose that engine");
  }
  return {};
}

namespace {

constexpr const char* kExamples =
    "  footing-sim\n  footing-sim --sensor tcp:127.0.0.1:7710 --track straight\n"
    "  footing-sim --interface leg --set turn_by=trunk\n"
    "  footing-sim --engine pose --lag-ms 100\n";

/// An option that sets one key of the config.
struct KeyOption {
  const char* name;
  const char* key;
  const char* help;
};
constexpr std::array kKeyOptions{
    KeyOption{"--engine", "engine", "Engine: gait or pose (default: gait)"},
    KeyOption{"--sensor", "sensor", "Address of footingd"},
    KeyOption{"--interface", "interface",
              "User interface of the gait engine: wrist, arm, leg, joystick or boards (default: "
              "wrist)"},
    KeyOption{"--track", "track",
              "Track of the gait engine: straight, 1 to 4 or another built-in name, or a JSON file "
              "(default: endless)"},
    KeyOption{"--subject", "subject", "Subject file of the pose engine, JSON"},
    KeyOption{"--mode", "mode",
              "Reconstruction mode of the pose engine: best or paper (default: best)"},
    KeyOption{"--metrics", "metrics",
              "Address of the metrics for Prometheus, tcp:127.0.0.1:PORT or unix:PATH"},
    KeyOption{"--lag-ms", "lag_ms",
              "Output delay of the pose engine, ms: 0, 100 or 200; longer is more accurate "
              "(default: 0)"},
};

struct Given {
  std::string file;
  std::vector<std::string> settings, listen;
  std::array<std::string, kKeyOptions.size()> values;
  bool print = false, origin = false, check = false, json = false, quiet = false;
};

std::unique_ptr<CLI::App> NewParser(Given& given) {
  auto app = cli::NewApp("footing-sim",
                         "Simulation server: drives a biped from a person's motion, or "
                         "reconstructs the body of a person on boards.",
                         kExamples);
  app->add_option("--config", given.file, "Config file, JSON");
  app->add_option("--set", given.settings,
                  "Setting, key=value; may be repeated; overrides the config file");
  app->add_option(
      "--listen", given.listen,
      "Address for clients, unix:PATH, tcp:HOST:PORT or tls:HOST:PORT; may be repeated");
  for (std::size_t i = 0; i < kKeyOptions.size(); ++i) {
    app->add_option(kKeyOptions[i].name, given.values[i], kKeyOptions[i].help);
  }
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

/// `binder` is bound to `config`. An option of its own goes before the file and --set.
Result<void> Apply(const Given& given, Config& config, config::Binder& binder) {
  std::vector<std::string> settings = given.settings;
  for (std::size_t i = 0; i < kKeyOptions.size(); ++i) {
    const std::string key = kKeyOptions[i].key;
    if (!given.values[i].empty()) settings.push_back(key + "=" + given.values[i]);
  }
  if (const auto done = binder.Apply(given.file, settings); !done) return done;
  for (std::size_t i = 0; i < kKeyOptions.size(); ++i) {
    if (!given.values[i].empty()) binder.SetOrigin(kKeyOptions[i].key, kKeyOptions[i].name);
  }
  if (!given.listen.empty()) {
    config.serving.listen = given.listen;
    binder.SetOrigin("listen", "--listen");
  }
  if (const auto checked = Check(config); !checked) return checked;
  return CheckApply(config, settings);
}

}  // namespace

std::optional<int> ReadCommandLine(int argc, char** argv, CommandLine& line) {
  Given given;
  const auto app = NewParser(given);
  if (const auto code = cli::Parse(*app, argc, argv)) return code;
  log::Start("footing-sim", given.quiet);
  line.json = given.json;
  config::Binder binder;
  line.config.Bind(binder);
  auto done = Apply(given, line.config, binder);
  if (done && given.print) {
    std::cout << (given.origin ? binder.PrintOrigins() : binder.Print()) << std::endl;
  }
  if (done && given.check) done = CheckService(line.config);
  if (!done) return cli::Report(done.error());
  if (given.print || given.check) return 0;
  return std::nullopt;
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

namespace {

using gait_service::GaitLine;
using pose_service::PoseLine;

auto MakePoseLine(const Config& config) {
  return [&config](int wake) { return PoseLine::Create(config.serving, config.pose, wake); };
}

auto MakeGaitLine(const Config& config) {
  return [&config](int wake) { return GaitLine::Create(config.serving, config.gait, wake); };
}

}  // namespace

Result<serving::Served> StartService(boost::asio::io_context& io, const Config& given,
                                     const std::string& version) {
  Config config = given;
  config.serving.version = version;
  if (config.engine == "pose") {
    return serving::StartServing<PoseLine>(io, config.serving, MakePoseLine(config));
  }
  return serving::StartServing<GaitLine>(io, config.serving, MakeGaitLine(config));
}

Result<void> CheckService(const Config& config) {
  if (config.engine == "pose") {
    return serving::CheckServing<PoseLine>(config.serving, MakePoseLine(config));
  }
  return serving::CheckServing<GaitLine>(config.serving, MakeGaitLine(config));
}

Config Reloaded(const Config& before, const Config& wanted,
                const std::vector<std::string>& changed_files,
                const std::function<void(const std::string& line)>& say) {
  Config old_config = before, new_config = wanted, next = before;
  next.serving.sessions = wanted.serving.sessions;
  next.serving.access.token_file = wanted.serving.access.token_file;
  next.serving.access.view_token_file = wanted.serving.access.view_token_file;
  next.serving.access.clients_file = wanted.serving.access.clients_file;
  config::Binder old_binder, new_binder, next_binder;
  old_config.Bind(old_binder);
  new_config.Bind(new_binder);
  next.Bind(next_binder);
  for (const auto& line :
       config::DescribeReload(old_binder, next_binder, new_binder, changed_files)) {
    say(line);
  }
  return next;
}

}  // namespace footing::footing_sim
