#include <iostream>
#include <nlohmann/json.hpp>

#include "clients/camera/tracking.h"
#include "clients/camera/video_port.h"
#include "common/cli/cli.h"
#include "common/net/address.h"
#include "common/net/device_link.h"
#include "common/runtime/log.h"

namespace {

using namespace footing;  // NOLINT: main is wiring

constexpr char kExamples[] =
    "  footing-camera calibrate --camera camera.json --device /dev/video0 --exposure-s 0.004\n"
    "  footing-camera lens --sheet sheet.svg      # to print, at any scale\n"
    "  footing-camera lens --camera camera.json --device /dev/video0 --exposure-s 0.02\n"
    "  footing-camera --camera camera.json --device /dev/video0 --exposure-s 0.004\n"
    "  footing-camera --camera camera.json --frames frames --repeat --seconds 10\n"
    "  footing-camera --camera camera.json --fifo /tmp/frames --json\n";

void Print(const camera::TrackingReport& report, const frames::CameraFile& camera, bool json) {
  nlohmann::ordered_json object = {{"frames", report.frames}, {"sent", report.sent}};
  for (std::size_t i = 0; i < report.found.size(); ++i)
    object["found"][stream::Name(camera.spheres[i].role)] = report.found[i];
  object["challenges_passed"] = report.challenges_passed;
  object["lights_refused"] = report.lights_refused;
  object["saturated"] = report.saturated;
  object["alarms"] = report.alarms;
  object["cost_p50_ms"] = report.cost_p50_ms;
  object["cost_p99_ms"] = report.cost_p99_ms;
  if (json) {
    std::cout << object << std::endl;
    return;
  }
  for (const auto& [key, value] : object.items()) std::cout << key << ": " << value << "\n";
}

/// As the command line names them; empty: the defaults.
struct Addresses {
  std::string to, sensor, preview;
};

/// The default place may belong to another footing-camera, which must not stop this one.
Result<void> TakePreview(const std::string& text, camera::TrackingOptions& options) {
  if (text == "none") return {};
  options.needs_preview = !text.empty();
  if (text.empty()) {
    options.preview = transport::DefaultAddress("camera", true);
    return {};
  }
  const auto address = transport::ParseAddress(text);
  if (!address) return address.error();
  options.preview = *address;
  return {};
}

int RunTracking(camera::TrackingOptions& options, const camera::CommandLine& line,
                const Addresses& addresses) {
  log::Start("footing-camera", line.quiet);
  if (const auto checked = Check(line); !checked) return cli::Report(checked.error());
  const auto camera = frames::ReadCameraFile(line.camera_file);
  if (!camera) return cli::Report(camera.error());
  options.camera = *camera;
  camera::ApplyExposure(line, options.camera);
  options.camera_path = line.camera_file;
  options.frames = line.frames;
  const auto devices = transport::AddressOrDefault(addresses.to, "devices");
  if (!devices) return cli::Report(devices.error());
  options.to = *devices;
  const auto clients = transport::AddressOrDefault(addresses.sensor, "sensor");
  if (!clients) return cli::Report(clients.error());
  options.sensor = *clients;
  if (const auto taken = TakePreview(addresses.preview, options); !taken)
    return cli::Report(taken.error());
  if (!camera->X_WC)
    log::Warning(line.camera_file +
                 " does not say where the camera is (position_W_m, rotation_WC): "
                 "hands are sent in the camera's own frame");
  const auto report = camera::Track(options);
  if (!report) return cli::Report(report.error());
  Print(*report, *camera, line.json);
  return report->sent_on ? 0 : cli::Report(report->sent_on.error());
}

}  // namespace

int main(int argc, char** argv) {
  auto app = cli::NewApp("footing-camera", "Tracks luminous spheres in the hands with a camera.",
                         kExamples);
  camera::TrackingOptions options;
  camera::CommandLine line;
  Addresses addresses;
  int exit_code = 0;
  AddCommandLine(*app, line);
  app->add_option("--to", addresses.to, device_link::kToHelp);
  app->add_option("--sensor", addresses.sensor,
                  "Address of footingd, where the lights of the camera file are switched on");
  app->add_option("--preview", addresses.preview,
                  "Unix socket for the preview in footing-view, unix:PATH, or none (default: "
                  "camera.sock beside footingd's sockets)");
  app->add_flag("--simulated", options.simulated, "Mark the hands as simulated");
  app->add_flag_callback(
      "--no-challenge", [&options] { options.challenge = false; },
      "Never switch a sphere's light to make sure that it is the sphere");
  app->add_option("--seconds", options.seconds, "Duration, s (default: until the frames end)")
      ->check(CLI::Range(0.0, 1e6));
  app->require_subcommand(0, 1);
  camera::AddCalibrateCommand(*app, exit_code);
  camera::AddLensCommand(*app, exit_code);
  if (const auto code = cli::Parse(*app, argc, argv)) return *code;
  if (!app->get_subcommands().empty()) return exit_code;
  return RunTracking(options, line, addresses);
}
