#include "common/cli/cli.h"
#include "daemon/offline/eval/arm/arm_command.h"
#include "daemon/offline/eval/board/board_command.h"
#include "daemon/offline/eval/clock/clock_command.h"
#include "daemon/offline/eval/features/features_command.h"
#include "daemon/offline/eval/gait/gait_command.h"
#include "daemon/offline/eval/gait/monkey_command.h"
#include "daemon/offline/eval/gait/transitions_command.h"
#include "daemon/offline/eval/gait/trial.h"
#include "daemon/offline/eval/momentum/momentum_command.h"
#include "daemon/offline/eval/pose/pose_command.h"
#include "daemon/offline/eval/replay/replay_command.h"
#include "daemon/offline/eval/report/command.h"
#include "daemon/offline/eval/stats/stats_command.h"
#include "daemon/offline/eval/tracks/plan_command.h"
#include "daemon/offline/eval/tracks/tracks_command.h"

int main(int argc, char** argv) {
  auto app = footing::cli::NewApp(
      "footing-eval", "Runs the pure code of the daemons offline, faster than real time.",
      "  footing-stream sample .     # writes the files that these examples read\n"
      "  footing-eval features --left left.csv --right right.csv --rate-hz 100 --json\n"
      "  footing-eval board --corners corners.csv --json\n"
      "  footing-eval clock --link poor --json\n"
      "  footing-eval gait --gait walk --speed 1 --seconds 60 --trials 1 --seed 1 --json\n"
      "  footing-eval transitions --from walk --to run --trials 20 --seed 1 --json\n"
      "  footing-eval monkey --seconds 60 --trials 2 --seed 1 --json\n"
      "  footing-eval tracks --interface wrist --track straight --trials 2 --seed 1 --json\n"
      "  footing-eval momentum --motion clip.bvh --json\n"
      "  footing-eval pose --motion clip.bvh --json\n"
      "  footing-eval arm --motion clip.bvh --json\n"
      "  footing-eval replay walk.mcap --json     # recorded by footing-log record --out "
      "walk.mcap");
  footing::eval::Shared shared;
  app->add_flag("--json", shared.json, "One JSON object on standard output");
  app->add_option_function<std::vector<std::string>>(
      "--gains", footing::eval::ReadGainsToo,
      "Gait tables, CSV; may be repeated. They replace the built-in tables of their gaits");
  app->require_subcommand(1);
  app->fallthrough();
  footing::eval::AddArmCommand(*app, shared);
  footing::eval::AddBoardCommand(*app, shared);
  footing::eval::AddClockCommand(*app, shared);
  footing::eval::AddFeaturesCommand(*app, shared);
  footing::eval::AddGaitCommand(*app, shared);
  footing::eval::AddMomentumCommand(*app, shared);
  footing::eval::AddMonkeyCommand(*app, shared);
  footing::eval::AddPlanCommand(*app, shared);
  footing::eval::AddPoseCommand(*app, shared);
  footing::eval::AddReplayCommand(*app, shared);
  footing::eval::AddStatsCommand(*app, shared);
  footing::eval::AddTracksCommand(*app, shared);
  footing::eval::AddTransitionsCommand(*app, shared);
  if (const auto code = footing::cli::Parse(*app, argc, argv)) return *code;
  return shared.exit_code;
}
