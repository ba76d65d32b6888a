#include <cstdint>
#include <memory>
#include <utility>

#include "clients/ctl/commands.h"
#include "common/cli/cli.h"

namespace footing::ctl {
namespace {

struct TrialOptions {
  std::string id, track, task, reason;
  std::uint64_t seed = 0, failure = 0;
};

/// Sends the command and prints that it was carried out.
void SendTrial(Shared& shared, v1::Command command, const nlohmann::ordered_json& out,
               const std::string& text) {
  if (const auto sent = SendToSimulation(shared, std::move(command), "footing-sim"); !sent) {
    shared.exit_code = cli::Report(sent.error());
    return;
  }
  Print(out, text, shared);
}

void StartTrial(const TrialOptions& options, Shared& shared) {
  v1::Command command;
  v1::StartTrial& start = *command.mutable_start_trial();
  start.set_character(1);
  start.set_trial(options.id);
  start.set_track(options.track);
  start.set_seed(options.seed);
  start.set_task(options.task);
  SendTrial(shared, std::move(command), {{"trial", options.id}, {"state", "ready"}},
            "trial " + options.id + " is ready: its clock starts at the start line");
}

void StopTrial(const TrialOptions& options, Shared& shared) {
  v1::Command command;
  command.mutable_stop_trial()->set_character(1);
  command.mutable_stop_trial()->set_trial(options.id);
  SendTrial(shared, std::move(command), {{"state", "stopped"}}, "the trial is stopped");
}

void CorrectFailure(const TrialOptions& options, bool restore, Shared& shared) {
  v1::Command command;
  v1::CorrectFailure& correct = *command.mutable_correct_failure();
  correct.set_failure(options.failure);
  correct.set_restore(restore);
  correct.set_reason(options.reason);
  const std::string state = restore ? "restored" : "withdrawn";
  SendTrial(shared, std::move(command), {{"failure", options.failure}, {"state", state}},
            "failure " + std::to_string(options.failure) + " is " + state);
}

void PutBack(Shared& shared) {
  v1::Command command;
  command.mutable_put_back()->set_character(1);
  SendTrial(shared, std::move(command), {{"state", "put back"}},
            "the character is put back; this is not a failure");
}

void AddCorrections(CLI::App& trial, const std::shared_ptr<TrialOptions>& options, Shared& shared) {
  const auto add = [&](const char* name, const char* help, bool restore) {
    CLI::App* command = trial.add_subcommand(name, help);
    command->add_option("FAILURE", options->failure, "Number of the failure, as in its event")
        ->required();
    command->add_option("--reason", options->reason, "Reason, for the record");
    command->callback([options, restore, &shared] { CorrectFailure(*options, restore, shared); });
  };
  add("withdraw", "Withdraw a failure that was counted by mistake; it stays in the recording",
      false);
  add("restore", "Count a withdrawn failure again", true);
}

}  // namespace

void AddTrialCommands(CLI::App& app, Shared& shared) {
  const auto options = std::make_shared<TrialOptions>();
  CLI::App* trial = app.add_subcommand("trial", "Start, stop and correct trials on a track");
  trial->require_subcommand(1);
  trial->fallthrough();
  trial->footer(
      "Examples (all connect to footing-sim):\n"
      "  footing-ctl trial start p07-wrist-1 --track straight --seed 7\n"
      "  footing-ctl trial withdraw 3 --reason \"a cable was pulled\"\n"
      "  footing-ctl trial stop");
  CLI::App* start = trial->add_subcommand("start", "Put the character before the start line");
  start->add_option("ID", options->id, "Id of the trial: 1 to 64 letters, digits, - _ and .")
      ->required();
  start->add_option("--track", options->track,
                    "Track: straight, 1 to 4, another built-in name, or the file that footing-sim "
                    "was started with (default: the current one)");
  start->add_option("--seed", options->seed, "Seed that draws the task of a straight track");
  start->add_option("--task", options->task, "Task (default: drawn with the seed)");
  start->callback([options, &shared] { StartTrial(*options, shared); });
  CLI::App* stop = trial->add_subcommand("stop", "End the trial before its finish line");
  stop->add_option("ID", options->id, "Id of the trial (default: the current one)");
  stop->callback([options, &shared] { StopTrial(*options, shared); });
  CLI::App* back = trial->add_subcommand("put-back", "Put the character back without a failure");
  back->callback([&shared] { PutBack(shared); });
  AddCorrections(*trial, options, shared);
}

}  // namespace footing::ctl
