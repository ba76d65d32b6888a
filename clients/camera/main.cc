#include <iostream>
#include <nlohmann/json.hpp>

#include "clients/camera/tracking.h"
#include "common/cli/cli.h"
#include "common/log/log.h"
#include "common/transport/address_or_default.h"

namespace {

using namespace footing;  // NOLINT: main is wiring

constexpr char kExamples[] =
    "  footing-camera --camera camera.json --device /dev/video0 --exposure-s 0.004\n"
    "  footing-camera --camera camera.json --frames frames --repeat --seconds 10\n"
    "  footing-camera --camera camera.json --fifo /tmp/frames --json\n";

void AddOptions(CLI::App& app, camera::TrackingOptions& options) {
  app.add_option("--device", options.device, "Camera, such as /dev/video0");
  app.add_option("--frames", options.folder, "Folder of frames: .pgm, .ppm or .yuyv files");
  app.add_option("--fifo", options.pipe,
                 "FIFO of PGM or PPM images, one after the other; - for standard input");
  app.add_option("--exposure-s", options.video.exposure_s, "Exposure time of a camera, s")
      ->check(CLI::Range(0.0001, 1.0));
  app.add_option("--gain", options.video.gain,
                 "Gain of a camera, on its own scale (-1: leave unchanged)")
      ->check(CLI::Range(-1, 100000));
  app.add_option("--latency-s", options.pipe_settings.latency_s,
                 "Time from the exposure of a FIFO's frame to its last byte, s")
      ->check(CLI::Range(0.0, 1.0));
  app.add_flag(
      "--stamped", options.pipe_settings.stamped,
      "Take a FIFO frame's exposure from its comment # time_ns, of the host's monotonic clock");
  app.add_flag("--repeat", options.repeats, "Play the frames of a folder again and again");
  app.add_flag("--simulated", options.simulated, "Mark the hands as simulated");
  app.add_option("--seconds", options.seconds, "Duration, s (default: until the frames end)")
      ->check(CLI::Range(0.0, 1e6));
}

void Print(const camera::TrackingReport& report, const frames::CameraFile& camera, bool json) {
  nlohmann::ordered_json object = {{"frames", report.frames}, {"sent", report.sent}};
  for (std::size_t i = 0; i < report.found.size(); ++i)
    object["found"][stream::Name(camera.spheres[i].role)] = report.found[i];
  object["saturated"] = report.saturated;
  object["cost_p50_ms"] = report.cost_p50_ms;
  object["cost_p99_ms"] = report.cost_p99_ms;
  if (json) {
    std::cout << object << std::endl;
    return;
  }
  for (const auto& [key, value] : object.items()) std::cout << key << ": " << value << "\n";
}

}  // namespace

int main(int argc, char** argv) {
  auto app = cli::NewApp("footing-camera", "Tracks luminous spheres in the hands with a camera.",
                         kExamples);
  camera::TrackingOptions options;
  std::string camera_file, to;
  bool json = false, quiet = false;
  app->add_option("--camera", camera_file, "Camera file, JSON (docs/camera.md)")->required();
  app->add_option("--to", to, "Address of footingd's device socket, unix:PATH or tcp:HOST:PORT");
  AddOptions(*app, options);
  app->add_flag("--json", json, "One JSON object on standard output, at the end");
  app->add_flag("-q,--quiet", quiet, "Log only warnings and errors");
  if (const auto code = cli::Parse(*app, argc, argv)) return *code;
  log::Start("footing-camera", quiet);
  if (options.device.empty() + options.folder.empty() + options.pipe.empty() != 2)
    return cli::Report(UsageError("name one of --device, --frames and --fifo"));
  const auto camera = frames::ReadCameraFile(camera_file);
  if (!camera) return cli::Report(camera.error());
  options.camera = *camera;
  options.camera_path = camera_file;
  const auto address = transport::AddressOrDefault(to, "devices");
  if (!address) return cli::Report(address.error());
  options.to = *address;
  if (!camera->X_WC)
    log::Warning(camera_file +
                 " does not say where the camera is (position_W_m, rotation_WC): "
                 "hands are sent in the camera's own frame");
  const auto report = camera::Track(options);
  if (!report) return cli::Report(report.error());
  Print(*report, *camera, json);
  return 0;
}
