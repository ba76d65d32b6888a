#include "daemon/offline/eval/fusion/fusion_command.h"

#include <memory>

#include "daemon/offline/eval/fusion/trial.h"
#include "daemon/offline/eval/pose/motion_options.h"
#include "daemon/offline/eval/pose/scene.h"
#include "daemon/offline/eval/report/print_report.h"

namespace footing::eval {
namespace {

struct Flags {
  PoseSceneOptions scene;
  std::vector<std::string> models;
  FusionOptions fusion;
};

Result<nlohmann::ordered_json> Evaluate(Flags flags) {
  flags.scene.standard_layout = flags.models.empty();
  flags.scene.settings.hand_device = pose_run::HandDevice::kKinect;
  flags.scene.settings.seed = flags.fusion.seed;
  const auto models = ReadPoseModels(flags.models, flags.scene.motion);
  if (!models) return models.error();
  const auto run = MakePoseScene(flags.scene);
  if (!run) return run.error();
  reconstruction::Options options;
  options.rate_hz = run->rate_hz;
  return RunFusionTrial(*run, *models, options, flags.fusion);
}

}  // namespace

void AddFusionCommand(CLI::App& app, Shared& shared) {
  auto* command = app.add_subcommand(
      "fusion",
      "Hips and knees in squats that hide the legs from a camera: its skeleton, boards, and both");
  const auto flags = std::make_shared<Flags>();
  AddMotionOptions(*command, flags->scene);
  command->add_option("--model", flags->models,
                      "Models, *.fmodel; may be repeated (default: the built-in ones)");
  command
      ->add_option("--squat-share", flags->fusion.squat_share,
                   "Height of the hips below which the legs are hidden, as a share of standing")
      ->check(CLI::Range(0.3, 1.0));
  command
      ->add_option("--prior-weight", flags->fusion.prior_weight, "Weight of the prior over poses")
      ->check(CLI::Range(0.01, 10.0));
  command
      ->add_option("--smooth-weight", flags->fusion.smooth_weight,
                   "Weight of staying near the last pose")
      ->check(CLI::Range(0.0, 10.0));
  command->add_option("--seed", flags->fusion.seed, "Seed of the skeleton's errors");
  command->callback(
      [flags, &shared] { shared.exit_code = PrintResult(Evaluate(*flags), shared.json); });
}

}  // namespace footing::eval
