#include <cmath>
#include <memory>

#include "clients/ctl/commands.h"
#include "clients/ctl/guided.h"
#include "common/board/layout.h"
#include "common/cli/cli.h"
#include "common/units/units.h"
#include "common/wire/wire.h"

namespace footing::ctl {
namespace {

using nlohmann::ordered_json;

struct Words {
  std::string rig = "main";
  std::string preset;
  double gap_mm = board::kUsualGapMm;
  bool check = false;
  bool script = false;
};

std::string Millimetres(double metres) { return std::to_string(std::lround(metres * 1e3)) + " mm"; }

ordered_json ToJson(const stream::BoardPose& pose) {
  return {{"x_m", pose.x_m}, {"y_m", pose.y_m}, {"yaw_rad", pose.yaw_rad}};
}

std::string ToText(const stream::BoardPose& pose) {
  return Millimetres(pose.x_m) + " forward, " + Millimetres(pose.y_m) + " left, turned by " +
         std::to_string(std::lround(RadiansToDegrees(pose.yaw_rad))) + " degrees";
}

Result<void> Layout(Session& session, const Words& words, const Shared& shared) {
  stream::BoardLayout layout;
  for (const auto& rig : session.setup()) {
    if (rig.rig == words.rig) layout = rig.layout;
  }
  if (!words.preset.empty()) {
    layout = *board::LayoutNamed(words.preset, words.gap_mm);
    layout.rig = words.rig;
    v1::Command command;
    *command.mutable_set_board_layout()->mutable_layout() = wire::ToProto(layout);
    if (const auto done = session.Call(std::move(command)); !done) return done.error();
  }
  if (layout.preset.empty() && !words.check) {
    return Failure("rig " + words.rig +
                   " has no layout; set one: footing-ctl layout --preset one_foot_each");
  }
  ordered_json out{{"rig", words.rig},
                   {"preset", layout.preset},
                   {"gap_mm", layout.gap_mm},
                   {"left", ToJson(layout.left)},
                   {"right", ToJson(layout.right)}};
  std::string text =
      "rig " + words.rig + ": " + layout.preset + "\n  left board:  " + ToText(layout.left);
  if (layout.preset != "single") text += "\n  right board: " + ToText(layout.right);
  Result<void> verdict;
  if (words.check) {
    guide::Wishes wishes;
    wishes.rig = words.rig;
    wishes.preset = words.preset;
    wishes.gap_mm = words.gap_mm;
    const auto results = RunGuided(session, wishes, {guide::Item::kLayout}, Talk{words.script});
    if (!results) return results.error();
    if (results->empty()) return NoDevice("rig " + words.rig + " has no board");
    out["check"] = ctl::ToJson(results->back());
    text += "\n" + ctl::ToText(results->back());
    if (!results->back().passed) verdict = Failure(results->back().note);
  }
  Print(out, text, shared);
  return verdict;
}

}  // namespace

void AddLayoutCommand(CLI::App& app, Shared& shared) {
  const auto words = std::make_shared<Words>();
  CLI::App* command = app.add_subcommand("layout", "How the boards lie: shows, sets or checks it");
  command->add_option("--preset", words->preset, "one_foot_each, side_by_side or single");
  command->add_option("--gap-mm", words->gap_mm, "Between the boards' facing edges")
      ->check(CLI::Range(0.0, 2000.0));
  command->add_option("--rig", words->rig, "What one person stands on");
  command->add_flag("--check", words->check, "Prove it: stand left, stand right, lean forward");
  command->add_flag("--script", words->script, "Prompts as lines PROMPT: ...");
  command->footer(
      "Examples:\n  footing-ctl layout\n"
      "  footing-ctl layout --preset one_foot_each --gap-mm 20 --check");
  command->callback([words, &shared] {
    if (!words->preset.empty() && !board::LayoutNamed(words->preset, 0)) {
      shared.exit_code =
          cli::Report(UsageError("--preset " + words->preset +
                                 ": no such layout; there are: one_foot_each side_by_side single"));
      return;
    }
    WithSession(shared, GuidedChannels(),
                [&](Session& session) { return Layout(session, *words, shared); });
  });
}

}  // namespace footing::ctl
