#include "clients/stream/players_command.h"

namespace footing::stream_client {

CLI::App* AddRunnerCommand(CLI::App& app, PlayersOptions& options) {
  CLI::App* const runner = app.add_subcommand(
      "runner", "A synthetic player who runs along the track, a Wiimote in each hand");
  runner->add_option(
      "--watch", options.simulation,
      "Address of footing-sim, which the player sees, unix:PATH, tcp:HOST:PORT or tls:HOST:PORT");
  return runner;
}

CLI::App* AddBuilderCommand(CLI::App& app, PlayersOptions& options) {
  CLI::App* const builder = app.add_subcommand(
      "builder", "A synthetic player who builds the track, a Wiimote in the role editor");
  builder->add_flag("--pits", options.pits, "Press B for pits, too");
  return builder;
}

}  // namespace footing::stream_client
