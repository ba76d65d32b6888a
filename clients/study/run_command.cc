#include <memory>
#include <optional>
#include <utility>

#include "clients/study/commands.h"
#include "clients/study/session/run_session.h"
#include "common/cli/cli.h"
#include "common/runtime/clock.h"
#include "common/net/address_or_default.h"

namespace footing::study {
namespace {

struct RunOptions {
  ProtocolOptions protocol;
  std::string participant;
  bool unattended = false;
  std::uint64_t seed = 1;
  std::string sensor;
  std::string simulation;
  std::string survey;
  bool withdraw = false;
  std::optional<std::uint64_t> undo, restore;
  std::string reason;
};

Result<SessionOptions> ToSession(const RunOptions& given, const LoadedProtocol& loaded) {
  SessionOptions options;
  options.participant = given.participant;
  options.study_folder = loaded.folder;
  options.protocol_text = loaded.text;
  options.unattended = given.unattended;
  options.answer_seed = given.seed;
  options.version = cli::Version();
  options.tables = loaded.tables;
  const auto sensor = transport::AddressOrDefault(given.sensor, "sensor");
  if (!sensor) return sensor.error();
  options.sensor = *sensor;
  const auto simulation = transport::AddressOrDefault(given.simulation, "simulation");
  if (!simulation) return simulation.error();
  options.simulation = *simulation;
  if (!given.survey.empty()) {
    const auto parsed = transport::ParseAddress(given.survey);
    if (!parsed) return parsed.error();
    options.survey = *parsed;
  }
  return options;
}

Result<Answer> Run(const RunOptions& given) {
  const auto loaded = Load(given.protocol.path, given.protocol.folder);
  if (!loaded) return loaded.error();
  const auto options = ToSession(given, *loaded);
  if (!options) return options.error();
  std::string did = "finished";
  Result<void> done;
  if (given.withdraw) {
    did = "withdrawn";
    done = AppendToSession(*options, loaded->protocol, records::EventKind::kWithdrawn,
                           {{"reason", given.reason}});
  } else if (given.undo || given.restore) {
    did = given.undo ? "failure undone" : "failure restored";
    done = AppendToSession(
        *options, loaded->protocol,
        given.undo ? records::EventKind::kFailureUndone : records::EventKind::kFailureRestored,
        {{"failure", given.undo ? *given.undo : *given.restore}, {"reason", given.reason}});
  } else {
    done = clock::FollowTimekeeper();
    if (done) done = RunSession(*options, loaded->protocol);
  }
  if (!done) return done.error();
  return Answer{{{"participant", given.participant}, {"result", did}, {"folder", loaded->folder}},
                given.participant + ": " + did};
}

}  // namespace

void AddRunCommand(CLI::App& app, Shared& shared) {
  const auto given = std::make_shared<RunOptions>();
  CLI::App* command =
      app.add_subcommand("run", "Run or resume the session of a participant, or correct it");
  AddProtocolOptions(*command, given->protocol);
  command->add_option("--participant", given->participant, "Code of the participant")->required();
  command->add_option("--sensor", given->sensor, "Address of footingd");
  command->add_option("--simulation", given->simulation, "Address of footing-sim");
  command->add_option("--survey", given->survey,
                      "Address for the participant's survey screen, footing-study survey (default: "
                      "ask in this terminal)");
  command->add_flag("--unattended", given->unattended,
                    "Without a person: no prompts and no waiting; surveys are answered at random, "
                    "marked synthetic");
  command->add_option("--seed", given->seed, "Seed of unattended answers");
  CLI::Option* withdraw =
      command->add_flag("--withdraw", given->withdraw,
                        "Record that the participant withdraws: no analysis uses the data");
  CLI::Option* undo =
      command->add_option("--undo-failure", given->undo, "Do not count the failure of this number");
  CLI::Option* restore = command->add_option("--restore-failure", given->restore,
                                             "Count the failure of this number again");
  withdraw->excludes(undo)->excludes(restore);
  undo->excludes(restore);
  command->add_option("--reason", given->reason, "Reason of a withdrawal or correction");
  command->callback([given, &shared] { Finish(Run(*given), shared); });
}

}  // namespace footing::study
