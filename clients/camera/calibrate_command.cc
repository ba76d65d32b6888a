#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "clients/camera/calibrate.h"
#include "clients/camera/command_line.h"
#include "common/cli/cli.h"
#include "common/runtime/log.h"
#include "common/net/address_or_default.h"

namespace footing::camera {
namespace {

struct CalibrateArguments {
  CommandLine line;
  std::string sensor;
};

double Rounded(double value, double step) { return std::round(value / step) * step; }

nlohmann::ordered_json ToJson(const BlinkReport& report) {
  nlohmann::ordered_json spheres = nlohmann::ordered_json::array();
  for (const BlinkReport::Sphere& one : report.spheres) {
    const auto& blink = one.calibrated.blink;
    const Eigen::Vector3d& c = blink.colour_dn;
    spheres.push_back(
        {{"role", stream::Name(one.role)},
         {"serial", one.serial},
         {"led", frames::ColourText(one.calibrated.led_rgb)},
         {"colour_dn", {Rounded(c.x(), 0.1), Rounded(c.y(), 0.1), Rounded(c.z(), 0.1)}},
         {"distance_m", one.calibrated.distance_m},
         {"found", one.calibrated.found}});
  }
  return {{"spheres", spheres},
          {"blur_px", report.profile.blur_px},
          {"blur_sd_px", report.profile.blur_sd_px},
          {"limb", report.profile.limb},
          {"limb_sd", report.profile.limb_sd}};
}

Result<BlinkReport> CalibrateAndStore(const CalibrateArguments& arguments) {
  if (const auto checked = Check(arguments.line); !checked) return checked.error();
  auto camera = frames::ReadUncalibratedCamera(arguments.line.camera_file);
  if (!camera) return camera.error();
  TakeExposure(arguments.line, *camera);
  const auto sensor = transport::AddressOrDefault(arguments.sensor, "sensor");
  if (!sensor) return sensor.error();
  auto report = Calibrate({*camera, arguments.line.frames, *sensor});
  if (!report) return report;
  frames::CameraFile calibrated = *camera;
  calibrated.settings.profile = report->profile;
  calibrated.spheres.clear();
  for (const BlinkReport::Sphere& one : report->spheres) {
    calibrated.spheres.push_back(
        {one.role, {one.calibrated.blink.colour_dn, one.radius_m}, one.calibrated.led_rgb});
  }
  const auto stored = frames::StoreSpheres(arguments.line.camera_file, calibrated);
  if (!stored) return stored.error();
  log::Info("stored what the spheres look like in " + arguments.line.camera_file);
  return report;
}

int RunCalibrate(const CalibrateArguments& arguments) {
  log::Start("footing-camera", arguments.line.quiet);
  const auto report = CalibrateAndStore(arguments);
  if (!report) return cli::Report(report.error());
  const nlohmann::ordered_json object = ToJson(*report);
  if (arguments.line.json) {
    std::cout << object << std::endl;
    return 0;
  }
  for (const auto& sphere : object["spheres"])
    std::cout << std::string(sphere["role"]) << ": light " << std::string(sphere["led"])
              << ", seen as " << sphere["colour_dn"] << "\n";
  std::cout << "blur: " << object["blur_px"] << " px\nlimb darkening: " << object["limb"] << "\n";
  return 0;
}

}  // namespace

void AddCalibrateCommand(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand(
      "calibrate",
      "Find the spheres of the PS Moves by their lights, and store what they look like");
  const auto arguments = std::make_shared<CalibrateArguments>();
  AddCommandLine(*command, arguments->line);
  command->add_option("--sensor", arguments->sensor,
                      "Address of footingd, unix:PATH or tcp:HOST:PORT");
  command->callback([arguments, &exit_code] { exit_code = RunCalibrate(*arguments); });
}

}  // namespace footing::camera
