#include "daemon/offline/eval/sphere_command.h"

#include <Eigen/Dense>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/frames/camera_file.h"
#include "common/frames/frame_folder.h"
#include "daemon/offline/eval/print_report.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;

struct Flags {
  std::string frames, camera;
};

ordered_json RowOf(const frames::CameraFile& camera, const std::string& file, double t_s,
                   std::size_t sphere, const sphere::Estimate& found) {
  const Eigen::Isometry3d X = camera.X_WC.value_or(Eigen::Isometry3d::Identity());
  const Eigen::Vector3d p = X * found.p_C_m;
  const Eigen::Matrix3d covariance = X.linear() * found.covariance_m2 * X.linear().transpose();
  const Eigen::Vector3d sd = covariance.diagonal().cwiseSqrt();
  return {{"t_s", t_s + camera.RowTime(found.centre_px.y())},
          {"x_m", p.x()},
          {"y_m", p.y()},
          {"z_m", p.z()},
          {"sd_x_m", sd.x()},
          {"sd_y_m", sd.y()},
          {"sd_z_m", sd.z()},
          {"confidence", found.confidence},
          {"cov_xy_m2", covariance(0, 1)},
          {"cov_xz_m2", covariance(0, 2)},
          {"cov_yz_m2", covariance(1, 2)},
          {"role", stream::Name(camera.spheres[sphere].role)},
          {"frame", file},
          {"u_px", found.centre_px.x()},
          {"v_px", found.centre_px.y()},
          {"radius_px", found.radius_px},
          {"saturated", found.is_saturated},
          {"occluded", found.is_occluded}};
}

Result<ordered_json> Evaluate(const Flags& flags) {
  const auto camera = frames::ReadCameraFile(flags.camera);
  if (!camera) return camera.error();
  const auto files = frames::FramesOf(flags.frames);
  if (!files) return files.error();
  sphere::Finder finder(camera->lens, camera->Targets(), camera->settings);
  ordered_json rows = ordered_json::array();
  std::size_t with_all = 0;
  for (std::size_t i = 0; i < files->size(); ++i) {
    const std::string& path = (*files)[i];
    const auto frame = frames::ReadFrame(path, camera->lens.width, camera->lens.height);
    if (!frame) return frame.error();
    const double t_s = frame->time_ns ? 1e-9 * static_cast<double>(*frame->time_ns)
                                      : static_cast<double>(i) / camera->rate_hz;
    const auto found = finder.Find(frame->View());
    bool all = true;
    for (std::size_t k = 0; k < found.size(); ++k) {
      all = all && found[k].has_value();
      if (!found[k]) continue;
      rows.push_back(RowOf(*camera, std::filesystem::path(path).filename(), t_s, k, *found[k]));
    }
    with_all += all ? 1 : 0;
  }
  return ordered_json{{"frames", files->size()},
                      {"found", with_all},
                      {"coordinates", camera->X_WC ? "world" : "camera"},
                      {"rows", rows}};
}

}  // namespace

void AddSphereCommand(CLI::App& app, Shared& shared) {
  auto* command =
      app.add_subcommand("sphere", "Positions of luminous spheres in the frames of a folder");
  const auto flags = std::make_shared<Flags>();
  command->add_option("--frames", flags->frames, "Folder of frames: .pgm, .ppm or .yuyv files")
      ->required();
  command->add_option("--camera", flags->camera, "Camera file, JSON (docs/camera.md)")->required();
  command->callback(
      [flags, &shared] { shared.exit_code = PrintResult(Evaluate(*flags), shared.json); });
}

}  // namespace footing::eval
