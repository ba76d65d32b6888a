#include "common/cli/server.h"

#include <cstring>
#include <iostream>
#include <memory>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/text.h"
#include "common/cli/cli.h"
#include "common/runtime/clock.h"
#include "common/runtime/log.h"
#include "common/runtime/service_manager.h"
#include "common/runtime/timer.h"

namespace footing::cli {
namespace {

void AddOption(CLI::App& app, const KeyOption& option, ServerLine& line) {
  const auto set = [&line, &option](const std::string& value) {
    line.options.emplace_back(option.name, option.key + "=" + value);
  };
  const CLI::Validator utf8(
      [](std::string& text) {
        return text::IsUtf8(text) ? std::string() : "its value is not text in UTF-8";
      },
      "");
  switch (option.kind) {
    case KeyOption::Kind::kText:
      app.add_option_function<std::string>(
          option.name,
          [set](const std::string& value) {
            if (!value.empty()) set(value);
          },
          option.help);
      return;
    case KeyOption::Kind::kList:
      app.add_option_function<std::vector<std::string>>(
             option.name,
             [set](const std::vector<std::string>& values) { set(nlohmann::json(values).dump()); },
             option.help)
          ->check(utf8);
      return;
    case KeyOption::Kind::kFlag:
      app.add_flag_callback(
          option.name, [set] { set("true"); }, option.help);
      return;
  }
}

}  // namespace

std::optional<int> ParseServerLine(const ServerProgram& program, int argc, char** argv,
                                   ServerLine& line) {
  const KeyOption listen{
      "--listen", "listen",
      "Address for clients, unix:PATH, tcp:HOST:PORT or tls:HOST:PORT; may be repeated",
      KeyOption::Kind::kList};
  bool quiet = false;
  line.program = program.name;
  const auto app = NewApp(program.name, program.what, program.examples);
  app->add_option("--config", line.file, "Config file, JSON");
  app->add_option("--set", line.settings,
                  "Setting, key=value; may be repeated; overrides the config file");
  AddOption(*app, listen, line);
  for (const KeyOption& option : program.options) AddOption(*app, option, line);
  CLI::Option* print =
      app->add_flag("--print-config", line.print, "Print the effective config and exit");
  app->add_flag(
         "--origin", line.origin,
         "With --print-config: where each value comes from, too (default, FILE:LINE, option)")
      ->needs(print);
  app->add_flag("--check-config", line.check,
                "Check the config and the files that it names, and exit");
  app->add_flag("--json", line.json, "Print the listening addresses as one JSON object");
  app->add_flag("-q,--quiet", quiet, "Log only warnings and errors");
  if (const auto code = Parse(*app, argc, argv)) return code;
  log::Start(program.name, quiet);
  return std::nullopt;
}

Result<void> ServerLine::Apply(config::Binder& binder) const {
  if (const auto done = binder.Apply(file, settings); !done) return done;
  for (const auto& [option, setting] : options) {
    if (const auto done = binder.ApplySetting(setting, option); !done) return done;
  }
  return {};
}

std::vector<std::string> ServerLine::AllSettings() const {
  std::vector<std::string> all = settings;
  for (const auto& [option, setting] : options) all.push_back(setting);
  return all;
}

void ServerLine::PrintIfAsked(const config::Binder& binder) const {
  if (print) std::cout << (origin ? binder.PrintOrigins() : binder.Print()) << std::endl;
}

int RunServer(const ServerLine& line,
              const std::function<Result<RunningServer>(boost::asio::io_context& io)>& start) {
  if (const auto done = clock::FollowTimekeeper(); !done) return Report(done.error());
  boost::asio::io_context io(1);
  const auto server = start(io);
  if (!server) return Report(server.error());
  service_manager::Notifier notifier(io, server->stuck);
  service_manager::ServiceSignals::Handlers handlers;
  handlers.stop = [&](int signal, std::function<void()> done) {
    log::Info(std::string("stopped by SIG") + sigabbrev_np(signal));
    notifier.Stopping();
    server->stop(StopReason(line.program, signal), std::move(done));
  };
  handlers.reload = [&] {
    if (const auto reloaded = server->reload(); !reloaded) {
      log::Warning("config not reloaded: the one in force stays: " + reloaded.error().message);
    }
  };
  const service_manager::ServiceSignals signals(io, std::move(handlers));
  notifier.Ready(server->status);
  // Its reader may send a signal at once.
  if (line.json) {
    std::cout << nlohmann::json{{"listening_on", server->listening_on}} << std::endl;
  }
  timer::Run(io);
  return 0;
}

}  // namespace footing::cli
