#include <memory>
#include <utility>

#include "clients/ctl/commands.h"
#include "common/cli/cli.h"
#include "common/runtime/data_file.h"
#include "common/stream/leg_turn.h"
#include "common/stream/user_interface.h"

namespace footing::ctl {
namespace {

struct InterfaceOptions {
  std::string name, turn_by, table;
};

Result<v1::Command> CommandOf(const InterfaceOptions& options) {
  const stream::UserInterface interface = stream::UserInterfaceNamed(options.name);
  if (interface == stream::UserInterface::kUnspecified) {
    return UsageError("unknown interface " + options.name +
                      "; there are: " + stream::UserInterfaceNames());
  }
  v1::Command command;
  v1::SetInterface& set = *command.mutable_set_interface();
  set.set_character(1);
  set.set_interface(static_cast<v1::UserInterface>(interface));
  if (!options.table.empty()) {
    auto table = config::ReadTextFile(options.table);
    if (!table) return table.error();
    set.set_table(std::move(table).value());
  }
  if (options.turn_by.empty()) return command;
  const auto source = stream::LegTurnSourceNamed(options.turn_by);
  if (source == stream::TurnSource::kUnspecified) {
    return UsageError("unknown --turn-by " + options.turn_by + "; there are: head, feet, trunk");
  }
  set.set_turn_by(static_cast<v1::TurnSource>(source));
  return command;
}

Result<void> ChangeInterface(const InterfaceOptions& options, const Shared& shared) {
  auto command = CommandOf(options);
  if (!command) return command.error();
  const auto sent = SendToSimulation(shared, std::move(command).value(), "footing-sim");
  // The server does not know the file's name.
  if (!sent && sent.error().kind == ErrorKind::kFailure && !options.table.empty())
    return Failure("with --table " + options.table + ": " + sent.error().message);
  if (!sent) return sent;
  Print({{"interface", options.name}}, "the interface is " + options.name, shared);
  return {};
}

}  // namespace

void AddInterfaceCommand(CLI::App& app, Shared& shared) {
  const auto options = std::make_shared<InterfaceOptions>();
  CLI::App* command = app.add_subcommand("interface", "Change the user interface between trials");
  command->add_option("NAME", options->name, "Interface: " + stream::UserInterfaceNames())
      ->required();
  command->add_option(
      "--turn-by", options->turn_by,
      "Body part that steers with the interface leg: head, feet or trunk (default: unchanged)");
  command->add_option("--table", options->table,
                      "Mapping table, such as one of footing-study ranges (default: the built-in "
                      "one)");
  command->footer(
      "Examples (connect to footing-sim):\n"
      "  footing-ctl interface arm\n"
      "  footing-ctl interface wrist --table P01_wrist.json\n"
      "  footing-ctl interface leg --turn-by trunk");
  command->callback([options, &shared] {
    if (const auto done = ChangeInterface(*options, shared); !done) {
      shared.exit_code = cli::Report(done.error());
    }
  });
}

}  // namespace footing::ctl
