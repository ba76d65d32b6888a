#include <cmath>
#include <memory>

#include "clients/ctl/acceptance_run.h"
#include "clients/ctl/guided.h"
#include "common/cli/cli.h"

namespace footing::ctl {
namespace {

using nlohmann::ordered_json;

std::string Rounded(double value) { return ordered_json(std::round(value * 1000) / 1000).dump(); }

/// Prints the verdict; a failure when it is one.
Result<void> Show(const AcceptanceVerdict& verdict, const Shared& shared) {
  const bool passed = guide::Passed(verdict.checks);
  ordered_json out{{"verdict", passed ? "pass" : "fail"}, {"checks", ordered_json::array()}};
  std::string text;
  std::string failed;
  for (const guide::Check& check : verdict.checks) {
    out["checks"].push_back({{"name", check.name},
                             {"passed", check.passed},
                             {"value", check.value},
                             {"bar", check.bar},
                             {"unit", check.unit},
                             {"note", check.note}});
    text += std::string(check.passed ? "  ok    " : "  FAIL  ") + check.name + ": " +
            Rounded(check.value) + " (bar " + Rounded(check.bar) + ") " + check.unit + "  " +
            check.note + "\n";
    if (!check.passed && failed.empty()) {
      failed = check.name + ": " + Rounded(check.value) + " (bar " + Rounded(check.bar) + ") " +
               check.unit + " " + check.note;
    }
  }
  out["recording"] = verdict.recording;
  Print(out, text + "verdict: " + (passed ? "pass" : "fail") + ", " + verdict.recording, shared);
  if (!passed) return Failure("not accepted; " + failed);
  return {};
}

struct AcceptanceArguments {
  AcceptanceOptions options;
  std::string replay;
};

}  // namespace

void AddAcceptanceCommand(CLI::App& app, Shared& shared) {
  const auto arguments = std::make_shared<AcceptanceArguments>();
  CLI::App* command = app.add_subcommand(
      "acceptance", "Guided acceptance test of a rig: writes a recording and prints the verdict");
  command->add_option("--minutes", arguments->options.minutes, "Duration, min (default 10)")
      ->check(CLI::Range(0.1, 120.0));
  command->add_option("--out", arguments->options.out,
                      "Recording to write (default acceptance.mcap)");
  command->add_flag("--force", arguments->options.replace, "Overwrite an existing recording");
  command->add_option("--rig", arguments->options.rig,
                      "Rig: the devices of one person (default main)");
  command->add_flag("--script", arguments->options.script,
                    "Print prompts as lines PROMPT: ... on standard error");
  command->add_option("--replay", arguments->replay,
                      "Recording of an acceptance: compute its verdict again; needs no device");
  command->footer(
      "Examples:\n  footing-ctl acceptance --out first.mcap\n"
      "  footing-ctl acceptance --replay first.mcap --json");
  command->callback([arguments, &shared] {
    if (!arguments->replay.empty()) {
      const auto verdict = ReplayAcceptance(arguments->replay);
      const Result<void> shown = verdict ? Show(*verdict, shared) : Result<void>(verdict.error());
      if (!shown) shared.exit_code = cli::Report(shown.error());
      return;
    }
    if (arguments->options.out.empty()) arguments->options.out = "acceptance.mcap";
    // Everything, so that the recording can be run again.
    WithSession(shared, {}, [&](Session& session) -> Result<void> {
      const auto verdict = RunAcceptance(session, arguments->options);
      if (!verdict) return verdict.error();
      return Show(*verdict, shared);
    });
  });
}

}  // namespace footing::ctl
