#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/runtime/data_file.h"
#include "common/runtime/write_file.h"
#include "common/frames/camera_file.h"

namespace footing::frames {
namespace {

using nlohmann::ordered_json;

void SetPose(ordered_json& object, const Eigen::Isometry3d& X_WC, const std::string& calibrated) {
  const Eigen::Vector3d p = X_WC.translation();
  const Eigen::Quaterniond q(X_WC.rotation());
  object["position_W_m"] = {p.x(), p.y(), p.z()};
  object["rotation_WC"] = {q.w(), q.x(), q.y(), q.z()};
  if (!calibrated.empty()) object["calibrated"] = calibrated;
}

void SetLens(ordered_json& object, const sphere::Lens& lens) {
  object["width"] = lens.width;
  object["height"] = lens.height;
  object["fx_px"] = lens.fx_px;
  object["fy_px"] = lens.fy_px;
  object["cx_px"] = lens.cx_px;
  object["cy_px"] = lens.cy_px;
  object["distortion"] = {lens.k1, lens.k2, lens.p1, lens.p2, lens.k3};
}

void SetSpheres(ordered_json& object, const CameraFile& camera) {
  ordered_json spheres = ordered_json::array();
  for (const HeldSphere& held : camera.spheres) {
    ordered_json colour = ordered_json::array();
    for (const double value : held.target.colour_dn)
      colour.push_back(std::round(100 * value) / 100);
    ordered_json one = {{"role", stream::Name(held.role)}, {"colour_dn", colour}};
    if (held.led_rgb) one["led"] = ColourText(*held.led_rgb);
    one["radius_m"] = held.target.radius_m;
    spheres.push_back(one);
  }
  object["spheres"] = spheres;
}

/// Changes keys of a camera file; the others stay.
template <typename Change>
Result<void> Rewrite(const std::string& path, const Change& change) {
  const auto text = config::ReadTextFile(path);
  if (!text) return text.error();
  if (const auto camera = ReadUncalibratedCamera(path); !camera) return camera.error();
  ordered_json object = ordered_json::parse(*text, nullptr, false, true);
  change(object);
  const auto written = config::ReplaceFile(path, object.dump(2) + "\n");
  return written ? Result<void>()
                 : Failure("cannot write " + path + ": " + written.error().message);
}

/// Changes keys of a camera file, or begins one where there is none.
template <typename Change>
Result<void> RewriteOrBegin(const std::string& path, const CameraFile& camera,
                            const Change& change) {
  std::error_code none;
  if (std::filesystem::exists(path, none)) return Rewrite(path, change);
  const auto written = config::ReplaceFile(path, ToJson(camera));
  return written ? Result<void>()
                 : Failure("cannot write " + path + ": " + written.error().message);
}

}  // namespace

std::string ToJson(const CameraFile& camera) {
  const sphere::Settings& settings = camera.settings;
  ordered_json object;
  SetLens(object, camera.lens);
  object.update({{"format", camera.format == sphere::PixelFormat::kYuyv ? "YUYV" : "SGRBG8"},
                 {"rate_hz", camera.rate_hz},
                 {"readout_s", camera.readout_s},
                 {"exposure_s", settings.shutter.exposure_s},
                 {"blur_px", settings.profile.blur_px},
                 {"blur_sd_px", settings.profile.blur_sd_px},
                 {"limb", settings.profile.limb},
                 {"limb_sd", settings.profile.limb_sd},
                 {"read_noise_dn", settings.noise.read_dn},
                 {"dn_per_electron", settings.noise.dn_per_electron},
                 {"noise_correlation", settings.noise.correlation}});
  if (camera.X_WC) SetPose(object, *camera.X_WC, camera.calibrated);
  if (!camera.spheres.empty()) SetSpheres(object, camera);
  return object.dump(2) + "\n";
}

Result<void> StorePose(const std::string& path, const Eigen::Isometry3d& X_WC,
                       const std::string& calibrated) {
  if (const auto camera = ReadCameraFile(path); !camera) return camera.error();
  return Rewrite(path, [&](ordered_json& object) { SetPose(object, X_WC, calibrated); });
}

Result<void> StoreSpheres(const std::string& path, const CameraFile& camera) {
  const sphere::Profile& profile = camera.settings.profile;
  return RewriteOrBegin(path, camera, [&](ordered_json& object) {
    object["exposure_s"] = camera.settings.shutter.exposure_s;
    object["blur_px"] = profile.blur_px;
    object["blur_sd_px"] = profile.blur_sd_px;
    object["limb"] = profile.limb;
    object["limb_sd"] = profile.limb_sd;
    SetSpheres(object, camera);
  });
}

Result<void> StoreLens(const std::string& path, const CameraFile& camera) {
  return RewriteOrBegin(path, camera, [&](ordered_json& object) { SetLens(object, camera.lens); });
}

std::string ColourText(std::uint32_t rgb) {
  char text[16];
  std::snprintf(text, sizeof text, "#%06x", static_cast<unsigned>(rgb & 0xffffff));
  return text;
}

}  // namespace footing::frames
