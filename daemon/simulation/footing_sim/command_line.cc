#include "daemon/simulation/footing_sim/command_line.h"

#include <filesystem>
#include <iostream>

#include "common/cli/cli.h"
#include "common/net/address.h"
#include "common/net/metrics_endpoint.h"
#include "common/runtime/config.h"
#include "common/runtime/files.h"
#include "common/runtime/log.h"
#include "daemon/simulation/engine/engine.h"
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

cli::ServerProgram Program() {
  return {
      "footing-sim",
      "Simulation server: drives a biped from a person's motion, or reconstructs the body of a "
      "person on boards. \"footing-sim export mjcf\" writes the biped and its track for MuJoCo.",
      "  footing-sim\n  footing-sim --sensor tcp:127.0.0.1:7710 --track straight\n"
      "  footing-sim --interface leg --set turn_by=trunk\n"
      "  footing-sim --gaits paper\n"
      "  footing-sim --engine pose --lag-ms 100\n"
      "  footing-sim export mjcf --track hills --out hills.xml\n",
      {{"--engine", "engine", "Engine: gait or pose (default: gait)"},
       {"--sensor", "sensor", "Address of footingd"},
       {"--interface", "interface",
        "User interface of the gait engine: wrist, arm, leg, joystick or boards (default: "
        "wrist)"},
       {"--track", "track",
        "Track of the gait engine: straight, 1 to 4 or another built-in name, or a JSON file "
        "(default: endless)"},
       {"--gaits", "gaits",
        "Controllers of the gaits: best, plain without style and foresight, or paper for those of "
        "the gait paper (default: best)"},
       {"--subject", "subject", "Subject file of the pose engine, JSON"},
       {"--mode", "mode", "Reconstruction mode of the pose engine: best or paper (default: best)"},
       {"--metrics", "metrics",
        "Address of the metrics for Prometheus, tcp:127.0.0.1:PORT or unix:PATH"},
       {"--lag-ms", "lag_ms",
        "Output delay of the pose engine, ms: 0, 100 or 200; longer is more accurate "
        "(default: 0)"}}};
}

Result<Config> ReadConfig(const cli::ServerLine& line) {
  Config config;
  config::Binder binder;
  config.Bind(binder);
  if (const auto done = line.Apply(binder); !done) return done.error();
  if (const auto done = Check(config); !done) return done.error();
  if (const auto done = CheckApply(config, line.AllSettings()); !done) return done.error();
  line.PrintIfAsked(binder);
  if (!line.check) return config;
  const auto checked = CheckService(config);
  return checked ? Result<Config>(config) : checked.error();
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

Result<serving::Served> StartEngine(boost::asio::io_context& io, const Config& config) {
  if (config.engine == "pose") {
    return serving::StartServing<PoseLine>(io, config.serving, MakePoseLine(config));
  }
  return serving::StartServing<GaitLine>(io, config.serving, MakeGaitLine(config));
}

}  // namespace

Result<cli::RunningServer> StartService(boost::asio::io_context& io, const cli::ServerLine& line,
                                        const Config& given, const std::string& version) {
  Config config = given;
  config.serving.version = version;
  const auto served = StartEngine(io, config);
  if (!served) return served.error();
  return cli::RunningServer{"engine " + config.engine, served->listening_on, served->stuck,
                            served->stop,
                            [line, config, reload = served->reload]() mutable -> Result<void> {
                              const auto wanted = ReadConfig(line);
                              if (!wanted) return wanted.error();
                              const auto changed_files = reload(wanted->serving);
                              if (!changed_files) return changed_files.error();
                              config = Reloaded(config, *wanted, *changed_files, log::Info);
                              return {};
                            }};
}

namespace {

Result<void> ExportMjcf(const std::string& track, const std::string& out, bool replace) {
  if (!out.empty() && !replace && std::filesystem::exists(out)) {
    return UsageError(out + " exists; name another file, or give --replace");
  }
  const auto texts = engine_files::ReadTexts({.track = track});
  if (!texts) return texts.error();
  const auto mjcf = engine::ExportMjcf(*texts, {}, std::string("footing-sim ") + cli::Version());
  if (!mjcf) return mjcf.error();
  if (out.empty()) {
    std::cout << *mjcf << std::flush;
    return std::cout ? Result<void>() : Failure("cannot write to standard output");
  }
  const auto written = config::ReplaceFile(out, *mjcf);
  return written ? written : Failure("cannot write " + out + ": " + written.error().message);
}

}  // namespace

std::optional<int> RunExport(int argc, char** argv) {
  if (argc < 2 || std::string(argv[1]) != "export") return std::nullopt;
  std::string track = gait_service::Config().track, out;
  bool replace = false;
  const auto app = cli::NewApp("footing-sim export", "Writes the simulation's model to a file.",
                               "  footing-sim export mjcf --track hills --out hills.xml\n"
                               "  footing-sim export mjcf > endless.xml");
  app->require_subcommand(1);
  CLI::App* mjcf = app->add_subcommand(
      "mjcf",
      "The biped of the gait engine with its track, its motors and its start, MJCF of MuJoCo. The "
      "body of the pose engine has no such model: it is reconstructed, not simulated.");
  mjcf->add_option("--track", track, "Track: a built-in name, or a JSON file")
      ->capture_default_str();
  mjcf->add_option("--out", out, "File to write (default: standard output)");
  mjcf->add_flag("--replace", replace, "Overwrite an existing file");
  if (const auto code = cli::Parse(*app, argc - 1, argv + 1)) return code;
  const auto done = ExportMjcf(track, out, replace);
  return done ? 0 : cli::Report(done.error());
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
  Config next = before;
  next.serving.sessions = wanted.serving.sessions;
  next.serving.access.token_file = wanted.serving.access.token_file;
  next.serving.access.view_token_file = wanted.serving.access.view_token_file;
  next.serving.access.clients_file = wanted.serving.access.clients_file;
  for (const auto& line : config::DescribeReload(before, next, wanted, changed_files)) say(line);
  return next;
}

}  // namespace footing::footing_sim
