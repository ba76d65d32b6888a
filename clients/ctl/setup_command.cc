#include <algorithm>
#include <memory>

#include "clients/ctl/commands.h"
#include "clients/ctl/gesture_command.h"
#include "clients/ctl/guided.h"
#include "common/board/layout.h"
#include "common/cli/cli.h"
#include "common/frames/camera_file.h"

namespace footing::ctl {
namespace {

struct SetUpArguments {
  guide::SetUpOptions options;
  std::vector<std::string> only;
  std::vector<std::string> body_roles;
  double mass_kg = 0;
  bool yes = false;
  bool script = false;
};

constexpr double kScriptSettleS = 2;
constexpr double kEffectsSeenS = 1.2;

/// The camera's sphere that is held on the marks: the first of its file.
Result<void> TakeCamera(SetUpArguments& arguments, const std::vector<guide::Item>& items) {
  const bool is_named = std::find(items.begin(), items.end(), guide::Item::kCamera) != items.end();
  if (arguments.options.camera_file.empty()) {
    if (!is_named) return {};
    return UsageError("--only camera needs --camera FILE, the file that footing-camera runs with");
  }
  const auto camera = frames::ReadCameraFile(arguments.options.camera_file);
  if (!camera) return camera.error();
  arguments.options.camera_role = camera->spheres.front().role;
  arguments.options.camera_radius_m = camera->spheres.front().target.radius_m;
  return {};
}

/// The items that the arguments name; UsageError when they contradict each other.
Result<std::vector<guide::Item>> Validate(SetUpArguments& arguments) {
  std::vector<guide::Item> items;
  for (const std::string& name : arguments.only) {
    const auto item = guide::ItemNamed(name);
    if (!item) {
      std::string known;
      for (const guide::Item one : guide::AllItems()) known += std::string(" ") + guide::Name(one);
      return UsageError("--only " + name + ": no such item; must be one of:" + known);
    }
    items.push_back(*item);
  }
  auto roles = BodyRoles(arguments.body_roles);
  if (!roles) return roles.error();
  arguments.options.body_roles = std::move(roles).value();
  if (!arguments.options.preset.empty() && !board::LayoutNamed(arguments.options.preset, 0)) {
    return UsageError("--preset " + arguments.options.preset +
                      ": no such layout; must be one of: one_foot_each side_by_side single");
  }
  if (const auto camera = TakeCamera(arguments, items); !camera) return camera.error();
  if (arguments.mass_kg > 0) arguments.options.mass_kg = arguments.mass_kg;
  if (arguments.script || arguments.yes) arguments.options.settle_s = kScriptSettleS;
  return items;
}

/// An item that was asked for by name, and for which the rig has no device, was not done.
Result<void> AllDone(const std::vector<guide::Item>& items,
                     const std::vector<stream::SetupItem>& results, const std::string& rig) {
  for (const guide::Item item : items) {
    const std::string name = guide::Name(item);
    const bool done = std::any_of(results.begin(), results.end(),
                                  [&](const stream::SetupItem& one) { return one.name == name; });
    if (!done) {
      return NoDevice("--only " + name + ": nothing done, rig " + rig +
                      " has no attached device for it; footing-ctl devices lists them");
    }
  }
  return {};
}

Result<void> Setup(Session& session, const SetUpArguments& arguments,
                   const std::vector<guide::Item>& items, const Shared& shared) {
  const auto results =
      RunGuided(session, arguments.options, items, PromptOptions{arguments.script});
  if (!results) return results.error();
  // So that the last answers' effects on the devices are seen.
  session.RunFor(kEffectsSeenS);
  const auto list = ItemsOf(session, arguments.options.rig, *results);
  const bool whole = items.empty();
  if (const auto printed = PrintItems(session, arguments.options.rig, list, whole, shared);
      !printed) {
    return printed;
  }
  for (const auto& result : *results) {
    if (!result.passed) return Failure(ToText(result));
  }
  return AllDone(items, *results, arguments.options.rig);
}

}  // namespace

void AddSetupCommand(CLI::App& app, Shared& shared) {
  const auto arguments = std::make_shared<SetUpArguments>();
  CLI::App* command =
      app.add_subcommand("setup",
                         "Guided setup of a rig: adapter, pairing, roles, layout, tare, "
                         "mounting, weigh, camera, checks");
  command->add_option("--rig", arguments->options.rig,
                      "Rig: the devices of one person (default main)");
  command
      ->add_option("--only", arguments->only, "Item to run; may be repeated (default: all items)")
      ->delimiter(',')
      ->allow_extra_args(false);
  command
      ->add_option(
          "--worn", arguments->body_roles,
          "Roles of the remotes, such as left_leg,right_leg (default: their present roles)")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option(
      "--preset", arguments->options.preset,
      "Layout of the boards: one_foot_each, side_by_side or single (default: the recorded one)");
  command
      ->add_option("--gap-mm", arguments->options.gap_mm, "Gap between the boards, mm (default 20)")
      ->check(CLI::Range(0.0, 2000.0));
  command
      ->add_option("--mass-kg", arguments->mass_kg,
                   "Mass of the person, kg, to compare the weighing with (default: not compared)")
      ->check(CLI::Range(10.0, 200.0));
  command
      ->add_option("--patience", arguments->options.patience_s,
                   "Timeout of an item, s (default 60)")
      ->check(CLI::Range(1.0, 3600.0));
  command->add_option("--tries", arguments->options.tries, "Attempts for each item (default 2)")
      ->check(CLI::Range(1, 10));
  command->add_option("--camera", arguments->options.camera_file,
                      "Camera file of the running footing-camera, whose pose is calibrated");
  command->add_flag("--yes", arguments->yes,
                    "Do not wait for Enter at steps that no sensor can confirm");
  command->add_flag(
      "--script", arguments->script,
      "Print prompts as lines PROMPT: ... on standard error, for a program that drives "
      "the devices");
  command->footer(
      "Items, in order: adapter pairing roles layout tare mounting weigh camera checks\n"
      "Examples:\n  footing-ctl setup --worn left_leg,right_leg\n"
      "  footing-ctl setup --only layout --only tare      # two items alone\n"
      "  footing-ctl setup --only camera --camera camera.json   # while footing-camera runs\n"
      "  footing-ctl setup --mass-kg 70 --json");
  command->callback([arguments, &shared] {
    const auto items = Validate(*arguments);
    if (!items) {
      shared.exit_code = cli::Report(items.error());
      return;
    }
    WithSession(shared, GuidedChannels(),
                [&](Session& session) { return Setup(session, *arguments, *items, shared); });
  });
}

}  // namespace footing::ctl
