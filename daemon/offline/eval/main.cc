#include "common/cli/cli.h"
#include "daemon/offline/eval/arm.h"
#include "daemon/offline/eval/attitude.h"
#include "daemon/offline/eval/board.h"
#include "daemon/offline/eval/calibration.h"
#include "daemon/offline/eval/clock.h"
#include "daemon/offline/eval/features.h"
#include "daemon/offline/eval/fusion.h"
#include "daemon/offline/eval/gait.h"
#include "daemon/offline/eval/gait_trial.h"
#include "daemon/offline/eval/hand.h"
#include "daemon/offline/eval/momentum.h"
#include "daemon/offline/eval/pose.h"
#include "daemon/offline/eval/pose_replay.h"
#include "daemon/offline/eval/reconstruct.h"
#include "daemon/offline/eval/report.h"
#include "daemon/offline/eval/sphere.h"
#include "daemon/offline/eval/spirals.h"
#include "daemon/offline/eval/stats.h"
#include "daemon/offline/eval/tracks.h"
#include "daemon/offline/eval/transitions.h"

namespace {

constexpr char kExamples[] =
    "  footing-stream sample .     # writes the files that these examples read\n"
    "  footing-eval features --left left.csv --right right.csv --rate-hz 100 --json\n"
    "  footing-eval features --decisions --features paper --trials 5 --seed 1 --json\n"
    "  footing-eval board --corners corners.csv --json\n"
    "  footing-eval clock --link poor --json\n"
    "  footing-eval gait --gait walk --speed 1 --seconds 60 --trials 1 --seed 1 --json\n"
    "  footing-eval transitions --from walk --to run --trials 20 --seed 1 --json\n"
    "  footing-eval style --gait walk --speeds 0.5,1.2 --json\n"
    "  footing-eval monkey --seconds 60 --trials 2 --seed 1 --json\n"
    "  footing-eval tracks --interface wrist --track straight --trials 2 --seed 1 --json\n"
    "  footing-eval plan straight 1 --out tracks.svg\n"
    "  footing-eval momentum --motion clip.bvh --json\n"
    "  footing-eval pose --motion clip.bvh --json\n"
    "  footing-eval reconstruct --motion clip.bvh --out poses --json\n"
    "  footing-eval arm --motion clip.bvh --json\n"
    "  footing-eval attitude --imu imu.csv --rate-hz 100 --json\n"
    "  footing-eval hand --motion clip.bvh --json\n"
    "  footing-eval fusion --motion clip.bvh --json\n"
    "  footing-eval spheres --condition clutter --distance-m 2 --frames 10 --out frames --json\n"
    "  footing-eval sphere --frames frames --camera frames/camera.json --json\n"
    "  footing-eval calibration --method marks --boards 1 --trials 1 --json\n"
    "  footing-eval spirals --seeds 20 --json\n"
    "  footing-eval smooth session.mcap --out smooth.mcap\n"
    "  footing-eval replay walk.mcap --json     # recorded by footing-log record "
    "--from-ring --out walk.mcap";

void AddCommands(CLI::App& app, footing::eval::Shared& shared) {
  using namespace footing::eval;  // NOLINT: a list
  AddArmCommand(app, shared);
  AddAttitudeCommand(app, shared);
  AddBoardCommand(app, shared);
  AddCalibrationCommand(app, shared);
  AddClockCommand(app, shared);
  AddFeaturesCommand(app, shared);
  AddFusionCommand(app, shared);
  AddGaitCommand(app, shared);
  AddHandCommand(app, shared);
  AddMomentumCommand(app, shared);
  AddMonkeyCommand(app, shared);
  AddPlanCommand(app, shared);
  AddPoseCommand(app, shared);
  AddReconstructCommand(app, shared);
  AddReplayCommand(app, shared);
  AddSmoothCommand(app, shared);
  AddSphereCommand(app, shared);
  AddSpheresCommand(app, shared);
  AddSpiralsCommand(app, shared);
  AddStatsCommand(app, shared);
  AddStyleCommand(app, shared);
  AddTracksCommand(app, shared);
  AddTransitionsCommand(app, shared);
}

}  // namespace

int main(int argc, char** argv) {
  auto app = footing::cli::NewApp(
      "footing-eval", "Runs the pure code of the daemons offline, faster than real time.",
      kExamples);
  footing::eval::Shared shared;
  app->add_flag("--json", shared.json, "One JSON object on standard output");
  app->add_option_function<std::vector<std::string>>(
      "--gains", footing::eval::ReadGainsToo,
      "Gait tables, CSV; may be repeated. They replace the built-in tables of their gaits");
  app->add_option_function<std::string>(
         "--gaits", footing::eval::UseGaits,
         "Controllers of the gaits: best, plain for the same without "
         "style, or paper for the state "
         "machines and equations as the gait paper prints them")
      ->check(CLI::IsMember({"best", "plain", "paper"}));
  app->require_subcommand(1);
  app->fallthrough();
  AddCommands(*app, shared);
  if (const auto code = footing::cli::Parse(*app, argc, argv)) return *code;
  return shared.exit_code;
}
