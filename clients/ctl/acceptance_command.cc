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

struct Words {
  AcceptanceOptions options;
  std::string replay;
};

}  // namespace

void AddAcceptanceCommand(CLI::App& app, Shared& shared) {
  const auto words = std::make_shared<Words>();
  CLI::App* command = app.add_subcommand(
      "acceptance", "Guided minutes with the devices that end in a recording and a verdict");
  command->add_option("--minutes", words->options.minutes, "How long in all (10)")
      ->check(CLI::Range(0.1, 120.0));
  command->add_option("--out", words->options.out, "The recording (acceptance.mcap)");
  command->add_flag("--force", words->options.replace, "Overwrite an existing recording");
  command->add_option("--rig", words->options.rig, "What one person wears or stands on");
  command->add_flag("--script", words->options.script, "Prompts as lines PROMPT: ...");
  command->add_option("--replay", words->replay,
                      "Compute the verdict again from such a recording; needs no device");
  command->footer(
      "Examples:\n  footing-ctl acceptance --out first.mcap\n"
      "  footing-ctl acceptance --replay first.mcap --json");
  command->callback([words, &shared] {
    if (!words->replay.empty()) {
      const auto verdict = ReplayAcceptance(words->replay);
      const Result<void> shown = verdict ? Show(*verdict, shared) : Result<void>(verdict.error());
      if (!shown) shared.exit_code = cli::Report(shown.error());
      return;
    }
    if (words->options.out.empty()) words->options.out = "acceptance.mcap";
    // Everything, so that the recording can be run again.
    WithSession(shared, {}, [&](Session& session) -> Result<void> {
      const auto verdict = RunAcceptance(session, words->options);
      if (!verdict) return verdict.error();
      return Show(*verdict, shared);
    });
  });
}

}  // namespace footing::ctl
