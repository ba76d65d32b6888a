#include <cmath>
#include <memory>

#include "clients/ctl/acceptance_text.h"
#include "clients/ctl/commands.h"
#include "clients/ctl/guided.h"
#include "common/board/layout.h"
#include "common/cli/cli.h"
#include "common/base/units.h"
#include "common/wire/wire.h"

namespace footing::ctl {
namespace {

using nlohmann::ordered_json;

struct LayoutArguments {
  std::string rig = "main";
  std::string preset;
  double gap_mm = board::kUsualGapMm;
  bool check = false;
  bool script = false;
};

std::string Millimetres(double metres) { return std::to_string(std::lround(metres * 1e3)) + " mm"; }

std::string PoseText(const stream::BoardPose& pose) {
  return Millimetres(pose.x_m) + " forward, " + Millimetres(pose.y_m) + " left, turned by " +
         std::to_string(std::lround(RadiansToDegrees(pose.yaw_rad))) + " degrees";
}

Result<void> Layout(Session& session, const LayoutArguments& arguments, const Shared& shared) {
  stream::BoardLayout layout;
  for (const auto& rig : session.setup()) {
    if (rig.rig == arguments.rig) layout = rig.layout;
  }
  v1::CommandResult set;
  if (!arguments.preset.empty()) {
    layout = *board::LayoutNamed(arguments.preset, arguments.gap_mm);
    layout.rig = arguments.rig;
    v1::Command command;
    *command.mutable_set_board_layout()->mutable_layout() = wire::ToProto(layout);
    const auto done = session.Call(std::move(command));
    if (!done) return done.error();
    set = *done;
  }
  if (layout.preset.empty() && !arguments.check) {
    return Failure("rig " + arguments.rig +
                   " has no layout; set one: footing-ctl layout --preset one_foot_each");
  }
  ordered_json out{{"rig", arguments.rig},
                   {"preset", layout.preset},
                   {"gap_mm", layout.gap_mm},
                   {"left", BoardPoseJson(layout.left)},
                   {"right", BoardPoseJson(layout.right)}};
  std::string text =
      "rig " + arguments.rig + ": " + layout.preset + "\n  left board:  " + PoseText(layout.left);
  if (layout.preset != "single") text += "\n  right board: " + PoseText(layout.right);
  AddRemark(set, out, text);
  Result<void> verdict;
  if (arguments.check) {
    guide::SetUpOptions options;
    options.rig = arguments.rig;
    options.preset = arguments.preset;
    options.gap_mm = arguments.gap_mm;
    const auto results =
        RunGuided(session, options, {guide::Item::kLayout}, PromptOptions{arguments.script});
    if (!results) return results.error();
    if (results->empty()) {
      return NoDevice("rig " + arguments.rig + " has no board" +
                      (arguments.preset.empty() ? "" : ": its layout is set, but not checked"));
    }
    out["check"] = ToJson(results->back());
    text += "\n" + ToText(results->back());
    if (!results->back().passed) verdict = Failure(results->back().note);
  }
  Print(out, text, shared);
  return verdict;
}

}  // namespace

void AddLayoutCommand(CLI::App& app, Shared& shared) {
  const auto arguments = std::make_shared<LayoutArguments>();
  CLI::App* command = app.add_subcommand("layout", "Show, set or check the layout of the boards");
  command->add_option("--preset", arguments->preset,
                      "Layout: one_foot_each, side_by_side or single");
  command
      ->add_option("--gap-mm", arguments->gap_mm,
                   "Gap between the facing edges of the boards, mm (default 20)")
      ->check(CLI::Range(0.0, 2000.0));
  command->add_option("--rig", arguments->rig, "Rig: the devices of one person (default main)");
  command->add_flag("--check", arguments->check,
                    "Check the layout: stand left, stand right, lean forward");
  command->add_flag("--script", arguments->script,
                    "Print prompts as lines PROMPT: ... on standard error");
  command->footer(
      "Examples:\n  footing-ctl layout\n"
      "  footing-ctl layout --preset one_foot_each --gap-mm 20 --check");
  command->callback([arguments, &shared] {
    if (!arguments->preset.empty() && !board::LayoutNamed(arguments->preset, 0)) {
      shared.exit_code = cli::Report(
          UsageError("--preset " + arguments->preset +
                     ": no such layout; must be one of: one_foot_each side_by_side single"));
      return;
    }
    WithSession(shared, GuidedChannels(),
                [&](Session& session) { return Layout(session, *arguments, shared); });
  });
}

}  // namespace footing::ctl
