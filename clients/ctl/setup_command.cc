#include <memory>

#include "clients/ctl/commands.h"
#include "clients/ctl/gesture_command.h"
#include "clients/ctl/guided.h"
#include "common/board/layout.h"
#include "common/cli/cli.h"

namespace footing::ctl {
namespace {

struct Words {
  guide::Wishes wishes;
  std::vector<std::string> only;
  std::vector<std::string> worn;
  double mass_kg = 0;
  bool yes = false;
  bool script = false;
};

constexpr double kScriptSettleS = 2;
constexpr double kEffectsSeenS = 1.2;

/// What the words ask for; UsageError when they make no sense.
Result<std::vector<guide::Item>> Understand(Words& words) {
  std::vector<guide::Item> items;
  for (const std::string& name : words.only) {
    const auto item = guide::ItemNamed(name);
    if (!item) {
      std::string known;
      for (const guide::Item one : guide::AllItems()) known += std::string(" ") + guide::Name(one);
      return UsageError("--only " + name + ": no such item; there are:" + known);
    }
    items.push_back(*item);
  }
  auto worn = WornRoles(words.worn);
  if (!worn) return worn.error();
  words.wishes.worn = std::move(worn).value();
  if (!words.wishes.preset.empty() && !board::LayoutNamed(words.wishes.preset, 0)) {
    return UsageError("--preset " + words.wishes.preset +
                      ": no such layout; there are: one_foot_each side_by_side single");
  }
  if (words.mass_kg > 0) words.wishes.mass_kg = words.mass_kg;
  if (words.script || words.yes) words.wishes.settle_s = kScriptSettleS;
  return items;
}

Result<void> Setup(Session& session, const Words& words, const std::vector<guide::Item>& items,
                   const Shared& shared) {
  const auto results = RunGuided(session, words.wishes, items, Talk{words.script});
  if (!results) return results.error();
  // So that the last answers' effects on the devices are seen.
  session.RunFor(kEffectsSeenS);
  const auto list = ItemsOf(session, words.wishes.rig, *results);
  const bool whole = items.empty();
  if (const auto printed = PrintItems(session, words.wishes.rig, list, whole, shared); !printed) {
    return printed;
  }
  for (const auto& result : *results) {
    if (!result.passed) return Failure(ToText(result));
  }
  return {};
}

}  // namespace

void AddSetupCommand(CLI::App& app, Shared& shared) {
  const auto words = std::make_shared<Words>();
  CLI::App* command = app.add_subcommand(
      "setup",
      "Guides from the box to a ready rig: adapter, pairing, roles, layout, tare, "
      "mounting, weigh, checks");
  command->add_option("--rig", words->wishes.rig, "What one person wears or stands on");
  command->add_option("--only", words->only, "Do this item alone; may be repeated")
      ->delimiter(',')
      ->allow_extra_args(false);
  command
      ->add_option("--worn", words->worn,
                   "What the remotes are worn as, e.g. left_leg,right_leg; left out: as they are")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--preset", words->wishes.preset,
                      "Layout of the boards: one_foot_each, side_by_side or single");
  command->add_option("--gap-mm", words->wishes.gap_mm, "Between the boards")
      ->check(CLI::Range(0.0, 2000.0));
  command->add_option("--mass-kg", words->mass_kg, "The person's mass, to compare with")
      ->check(CLI::Range(10.0, 200.0));
  command
      ->add_option("--patience", words->wishes.patience_s, "Give an item up after so many seconds")
      ->check(CLI::Range(1.0, 3600.0));
  command->add_option("--tries", words->wishes.tries, "How often an item that fails is tried")
      ->check(CLI::Range(1, 10));
  command->add_flag("--yes", words->yes, "Do not wait for Enter where nothing can be sensed");
  command->add_flag("--script", words->script,
                    "Prompts as lines PROMPT: ... on standard error, for a program that drives "
                    "the devices");
  command->footer(
      "Items, in order: adapter pairing roles layout tare mounting weigh checks\n"
      "Examples:\n  footing-ctl setup --worn left_leg,right_leg\n"
      "  footing-ctl setup --only layout --only tare      # some items alone\n"
      "  footing-ctl setup --mass-kg 70 --json");
  command->callback([words, &shared] {
    const auto items = Understand(*words);
    if (!items) {
      shared.exit_code = cli::Report(items.error());
      return;
    }
    WithSession(shared, GuidedChannels(),
                [&](Session& session) { return Setup(session, *words, *items, shared); });
  });
}

}  // namespace footing::ctl
