#include "daemon/offline/eval/hand_command.h"

#include <memory>
#include <nlohmann/json.hpp>

#include "daemon/offline/eval/hand_trial.h"
#include "daemon/offline/eval/motion_options.h"
#include "daemon/offline/eval/pose_scene.h"
#include "daemon/offline/eval/print_report.h"

namespace footing::eval {
namespace {

struct Flags {
  PoseSceneOptions scene;
  HandTrialOptions trial;
};

Result<nlohmann::ordered_json> Evaluate(Flags flags) {
  flags.scene.settings.rate_hz = 120;
  flags.trial.seed = flags.scene.settings.seed;
  const auto run = MakeArmScene(flags.scene, pose_run::kFists);
  if (!run) return run.error();
  return RunHandTrial(*run, flags.trial);
}

}  // namespace

void AddHandCommand(CLI::App& app, Shared& shared) {
  auto* command = app.add_subcommand(
      "hand",
      "Hands that a camera sees, between its frames and while they are hidden: by the camera alone "
      "and with the inertial sensors of a PS Move");
  const auto flags = std::make_shared<Flags>();
  HandTrialOptions& trial = flags->trial;
  AddMotionOptions(*command, flags->scene);
  command
      ->add_option("--hidden-s", trial.hidden_s,
                   "Durations for which a hand is hidden, s, each in a run of its own")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 5.0));
  command->add_option("--seen-s", trial.seen_s, "Duration between them, s")
      ->check(CLI::Range(0.2, 60.0));
  command
      ->add_option("--sphere-m", trial.sphere_m,
                   "Distance of the sphere from the device's sensors, along its x, m")
      ->check(CLI::Range(0.0, 0.3));
  command
      ->add_option("--lamp-m", trial.lamp_m,
                   "While a hand is hidden, a lamp so far above it is taken for it, m; 0: none")
      ->check(CLI::Range(0.0, 2.0));
  command
      ->add_option("--common-share", trial.common_share,
                   "Share of the camera's variance that all frames have in common")
      ->check(CLI::Range(0.0, 1.0));
  command->add_option("--seed", flags->scene.settings.seed, "Seed of the errors");
  command->callback(
      [flags, &shared] { shared.exit_code = PrintResult(Evaluate(*flags), shared.json); });
}

}  // namespace footing::eval
