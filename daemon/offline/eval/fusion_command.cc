#include "daemon/offline/eval/fusion_command.h"

#include <memory>
#include <utility>

#include "common/base/units.h"
#include "daemon/offline/eval/fusion_trial.h"
#include "daemon/offline/eval/motion_options.h"
#include "daemon/offline/eval/pose_scene.h"
#include "daemon/offline/eval/print_report.h"
#include "daemon/offline/eval/write_text.h"

namespace footing::eval {
namespace {

struct Flags {
  PoseSceneOptions scene;
  std::vector<std::string> models;
  double camera_yaw_deg = 0;
  std::string figure;
};

Result<nlohmann::ordered_json> Evaluate(Flags flags) {
  flags.scene.standard_layout = flags.models.empty();
  pose_run::Settings& settings = flags.scene.settings;
  settings.hand_device = pose_run::HandDevice::kKinect;
  settings.joints = true;
  settings.kinect.yaw_rad = DegreesToRadians(flags.camera_yaw_deg);
  const auto models = ReadPoseModels(flags.models, flags.scene.motion);
  if (!models) return models.error();
  const auto run = MakePoseScene(flags.scene);
  if (!run) return run.error();
  reconstruction::Options options;
  options.rate_hz = run->rate_hz;
  auto report = RunFusionTrial(*run, *models, options);
  if (!report) return report.error();
  if (!flags.figure.empty()) {
    if (auto written = WriteText(flags.figure, report->figure); !written) return written.error();
  }
  return std::move(report->json);
}

}  // namespace

void AddFusionCommand(CLI::App& app, Shared& shared) {
  auto* command = app.add_subcommand(
      "fusion",
      "Joints that a body hides from a camera: its skeleton, boards, and both (paper, Figure 7)");
  const auto flags = std::make_shared<Flags>();
  pose_run::Settings& settings = flags->scene.settings;
  AddMotionOptions(*command, flags->scene);
  command->add_option("--model", flags->models,
                      "Models, *.fmodel; may be repeated (default: the built-in ones)");
  command
      ->add_option("--squat-share", settings.kinect.crouch_share,
                   "Height of the hips below which the legs are hidden, as a share of standing")
      ->check(CLI::Range(0.3, 1.0));
  command
      ->add_option("--camera-yaw-deg", flags->camera_yaw_deg,
                   "Direction of the camera from the person, degrees: 0 ahead, 90 to the left")
      ->check(CLI::Range(-180.0, 180.0));
  command->add_option("--seed", settings.seed, "Seed of the skeleton's errors");
  command->add_option("--figure", flags->figure, "Write Figure 7 of the pose paper, SVG file");
  command->callback(
      [flags, &shared] { shared.exit_code = PrintResult(Evaluate(*flags), shared.json); });
}

}  // namespace footing::eval
