#include <memory>

#include "clients/log/commands.h"
#include "clients/log/recalibrate.h"
#include "common/cli/cli.h"
#include "common/frames/camera_file.h"

namespace footing::log_client {
namespace {

using nlohmann::ordered_json;

struct RecalibrateOptions {
  std::string in, out, camera;
  std::string tracker = "camera";
  bool replace = false;
};

Result<ordered_json> RunRecalibrate(const RecalibrateOptions& options) {
  const auto camera = frames::ReadCameraFile(options.camera);
  if (!camera) return camera.error();
  if (!camera->X_WC)
    return InvalidData(options.camera +
                       " does not say where the camera is (position_W_m, rotation_WC): calibrate "
                       "it with footing-ctl setup --only camera");
  const auto report = Recalibrate(options.in, options.out, options.tracker, *camera->X_WC,
                                  std::string("footing-log ") + cli::Version(), options.replace);
  if (!report) return report.error();
  return ordered_json{{"input", options.in},
                      {"output", options.out},
                      {"messages", report->messages},
                      {"samples_recalibrated", report->samples},
                      {"samples_unchanged", report->untouched}};
}

}  // namespace

void AddRecalibrateCommand(CLI::App& app, Shared& shared) {
  CLI::App* command = app.add_subcommand(
      "recalibrate", "Write a copy of a recording with a new calibration applied to its hands");
  const auto options = std::make_shared<RecalibrateOptions>();
  command->add_option("IN", options->in, "Recording, MCAP file")->required();
  command->add_option("--camera", options->camera, "Camera file with the new pose, JSON")
      ->required();
  command->add_option("--out", options->out, "Output file, MCAP")->required();
  command->add_option("--tracker", options->tracker, "Name of the tracker (default camera)");
  command->add_flag("--force", options->replace, "Overwrite an existing file");
  command->callback([options, &shared] { Finish(RunRecalibrate(*options), shared); });
}

}  // namespace footing::log_client
