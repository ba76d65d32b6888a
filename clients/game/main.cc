#include <unistd.h>

#include <iostream>

#include "clients/game/host.h"
#include "common/cli/cli.h"
#include "common/net/address.h"
#include "common/runtime/log.h"

namespace {

using namespace footing;  // NOLINT: main is wiring

int Print(const game::Report& report, bool json) {
  std::cout << (json ? game::ToJson(report) + "\n" : game::ToText(report)) << std::flush;
  return 0;
}

/// The scores of a recording; exit code 4 when those published are others.
int PrintRecount(const std::string& path, bool json) {
  const auto session = recording::RecordedSession::Open(path);
  if (!session) return cli::Report(session.error());
  const auto recount = game::RecountGame(*session);
  if (!recount) return cli::Report(recount.error());
  Print(recount->counted, json);
  if (recount->equal) return 0;
  return cli::Report(InvalidData(
      path + ": the published scores differ from these: " + game::ToJson(recount->published)));
}

Result<void> Resolve(const std::string& sensor, const std::string& simulation,
                     game::HostOptions& options) {
  const auto at = transport::AddressOrDefault(sensor, "sensor");
  if (!at) return at.error();
  options.sensor = *at;
  const auto simulated = transport::AddressOrDefault(simulation, "simulation");
  if (!simulated) return simulated.error();
  options.simulation = *simulated;
  // Ids of trials differ from one game to the next.
  options.game.id = "game-" + std::to_string(getpid());
  if (options.game.players[0] == options.game.players[1])
    return UsageError("--players: the names must differ");
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  auto app = cli::NewApp("footing-game",
                         "Terrain game: one player builds the track, the other one runs on it.",
                         "  footing-game --players Ann Ben\n"
                         "  footing-game --rounds 4 --round-s 90 --pits\n"
                         "  footing-game --recording game.mcap --json    # scores, counted again");
  game::HostOptions options;
  game::GameOptions& rules = options.game;
  std::string sensor, simulation, recording;
  bool json = false;
  app->add_option("--sensor", sensor,
                  "Address of footingd, unix:PATH, tcp:HOST:PORT or tls:HOST:PORT");
  app->add_option("--simulation", simulation, "Address of footing-sim, the same way");
  app->add_option("--players", rules.players, "Names of both players; the first one runs first")
      ->check([](const std::string& name) {
        if (name.starts_with('-')) return "takes two names, not " + name;
        const char* const why = stream::WhyNotAPlayerName(name);
        return std::string(why == nullptr ? "" : why);
      });
  app->add_option("--rounds", rules.rounds, "Number of rounds; the players swap roles after each")
      ->check(CLI::Range(1, 20));
  app->add_option("--round-s", rules.round_s, "Duration of a round, s")
      ->check(CLI::Range(5.0, 600.0));
  app->add_option("--countdown-s", rules.countdown_s, "Countdown to each round, s")
      ->check(CLI::Range(0.0, 60.0));
  app->add_option("--pause-s", rules.pause_s, "Pause to swap the controllers, s")
      ->check(CLI::Range(0.0, 600.0));
  app->add_flag("--pits", rules.pits, "Button B lays pits");
  app->add_option("--seconds", options.seconds, "Duration, s (0: until the game is over)")
      ->check(CLI::Range(0.0, 1e6));
  app->add_option("--recording", recording, "Recording whose scores to count again, MCAP file");
  app->add_flag("--json", json, "Print one JSON object on standard output at the end");
  if (const auto code = cli::Parse(*app, argc, argv)) return *code;
  log::Start("footing-game", false);
  if (!recording.empty()) return PrintRecount(recording, json);
  if (const auto resolved = Resolve(sensor, simulation, options); !resolved)
    return cli::Report(resolved.error());
  options.text = !json;
  const auto report = game::RunGame(options);
  return report ? Print(*report, json) : cli::Report(report.error());
}
