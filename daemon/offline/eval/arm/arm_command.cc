#include "daemon/offline/eval/arm/arm_command.h"

#include <memory>
#include <nlohmann/json.hpp>

#include "daemon/offline/eval/arm/trial.h"
#include "daemon/offline/eval/pose/motion_options.h"
#include "daemon/offline/eval/pose/scene.h"
#include "daemon/offline/eval/report/print_report.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;

struct Flags {
  PoseSceneOptions scene;
  std::string model;
  double loop_minutes = 0;
};

Result<ordered_json> Evaluate(Flags flags) {
  flags.scene.settings.loop_s = 60 * flags.loop_minutes;
  const auto model = ReadArmModel(flags.model, flags.scene.motion);
  if (!model) return model.error();
  const auto run = MakeArmScene(flags.scene);
  if (!run) return run.error();
  return RunArmTrial(*run, *model);
}

}  // namespace

void AddArmCommand(CLI::App& app, Shared& shared) {
  auto* command = app.add_subcommand(
      "arm",
      "Arm poses estimated from a Wiimote with MotionPlus in each hand, compared with the motion");
  const auto flags = std::make_shared<Flags>();
  AddMotionOptions(*command, flags->scene);
  command->add_option("--model", flags->model, "Arm model, *.fmodel (default: built in)");
  command->add_option("--rate-hz", flags->scene.settings.rate_hz, "Frame rate, Hz")
      ->check(CLI::Range(30.0, 120.0));
  command->add_option("--seed", flags->scene.settings.seed, "Seed of the simulated device errors");
  command
      ->add_option(
          "--loop-minutes", flags->loop_minutes,
          "Total duration, min: the motion is played forwards and backwards until then (0: once)")
      ->check(CLI::Range(0.0, 60.0));
  command->callback(
      [flags, &shared] { shared.exit_code = PrintResult(Evaluate(*flags), shared.json); });
}

}  // namespace footing::eval
