#include "common/frames/camera_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/runtime/data_file.h"
#include "common/base/json_text.h"
#include "common/base/number.h"
#include "common/base/units.h"

namespace footing::frames {
namespace {

using nlohmann::json;

/// Reads one object: keeps the first problem, and finds keys that nobody asked for.
class Reader {
 public:
  Reader(const json& object, std::string place) : object_(object), place_(std::move(place)) {
    if (!object.is_object()) Fail("", "must be an object");
  }

  void Number(const char* key, double& value, double low, double high) {
    const json* found = Find(key);
    if (found == nullptr) return;
    if (!found->is_number() || !(*found >= low && *found <= high)) {
      return Fail(key, "must be a number from " + Short(low) + " to " + Short(high));
    }
    value = *found;
  }

  void Integer(const char* key, int& value, int low, int high) {
    double number = value;
    Number(key, number, low, high);
    if (number != std::floor(number)) Fail(key, "must be a whole number");
    value = static_cast<int>(number);
  }

  /// As many numbers as there are.
  std::vector<double> Numbers(const char* key, std::size_t count, double low, double high) {
    const json* found = Find(key);
    if (found == nullptr) return {};
    std::vector<double> numbers;
    if (found->is_array()) {
      for (const json& one : *found)
        if (one.is_number() && one >= low && one <= high) numbers.push_back(one);
    }
    if (numbers.size() == count && found->size() == count) return numbers;
    Fail(key,
         "must be " + std::to_string(count) + " numbers from " + Short(low) + " to " + Short(high));
    return {};
  }

  std::string Text(const char* key) {
    const json* found = Find(key);
    if (found == nullptr) return "";
    if (!found->is_string()) Fail(key, "must be a text");
    return found->is_string() ? found->get<std::string>() : "";
  }

  const json* Find(const char* key) {
    known_.push_back(key);
    if (!object_.is_object()) return nullptr;
    const auto found = object_.find(key);
    return found == object_.end() ? nullptr : &*found;
  }

  void Fail(const std::string& key, const std::string& what) {
    if (problem_.empty()) problem_ = place_ + (key.empty() ? "" : ", key " + key) + ": " + what;
  }

  /// Of all that was read; call it last.
  std::string Problem() {
    if (object_.is_object()) {
      for (const auto& [key, value] : object_.items()) {
        if (std::find(known_.begin(), known_.end(), key) == known_.end()) Fail(key, "unknown key");
      }
    }
    return problem_;
  }

 private:
  static std::string Short(double value) { return json(value).dump(); }

  const json& object_;
  std::string place_;
  std::vector<std::string> known_;
  std::string problem_;
};

std::optional<std::uint32_t> ParseColour(const std::string& text) {
  if (text.size() != 7 || text[0] != '#') return std::nullopt;
  std::uint32_t rgb = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + 1, end, rgb, 16);
  if (error != std::errc() || stop != end) return std::nullopt;
  return rgb;
}

Result<HeldSphere> ReadSphere(const json& object, const std::string& place) {
  HeldSphere sphere;
  Reader reader(object, place);
  const std::string role = reader.Text("role");
  sphere.role = stream::RoleNamed(role);
  if (!CanHoldSphere(sphere.role)) reader.Fail("role", "must be left_hand, right_hand or head");
  const auto colour = reader.Numbers("colour_dn", 3, 0, 255);
  if (colour.empty()) {
    reader.Fail("colour_dn", "is needed");
  } else {
    sphere.target.colour_dn = {colour[0], colour[1], colour[2]};
    const auto& value = sphere.target.colour_dn;
    if (value.maxCoeff() - value.minCoeff() < 20)
      reader.Fail("colour_dn", "must not be grey: its channels must be 20 DN apart or more");
  }
  reader.Number("radius_m", sphere.target.radius_m, 0.005, 0.2);
  if (const std::string led = reader.Text("led"); !led.empty()) {
    sphere.led_rgb = ParseColour(led);
    if (!sphere.led_rgb) reader.Fail("led", "must be a colour such as #ff00c8");
  }
  const std::string problem = reader.Problem();
  if (!problem.empty()) return InvalidData(problem);
  return sphere;
}

/// Which two spheres would be taken for each other, and why; empty for none.
std::string Confusable(const std::vector<HeldSphere>& spheres) {
  constexpr double kLeastApartDeg = 30;  // Within that a blob has a sphere's hue.
  const auto chroma = [&](std::size_t i) -> Eigen::Vector3d {
    const Eigen::Vector3d& colour_dn = spheres[i].target.colour_dn;
    return (colour_dn.array() - colour_dn.mean()).matrix().normalized();
  };
  for (std::size_t b = 1; b < spheres.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      const std::string both = "spheres " + std::to_string(a + 1) + " and " + std::to_string(b + 1);
      if (spheres[a].role == spheres[b].role) {
        return both + " both have the role " + stream::Name(spheres[a].role);
      }
      const double apart_deg =
          RadiansToDegrees(std::acos(std::clamp(chroma(a).dot(chroma(b)), -1.0, 1.0)));
      if (apart_deg >= kLeastApartDeg) continue;
      return both + ": their colours are " + text::Fixed(apart_deg, 0) +
             " degrees of hue apart, and could be mistaken for each other; choose lights at "
             "least " +
             text::Fixed(kLeastApartDeg, 0) + " degrees apart";
    }
  }
  return "";
}

void ReadLens(Reader& reader, sphere::Lens& lens) {
  reader.Integer("width", lens.width, 32, 4096);
  reader.Integer("height", lens.height, 32, 4096);
  reader.Number("fx_px", lens.fx_px, 1, 1e5);
  reader.Number("fy_px", lens.fy_px, 1, 1e5);
  reader.Number("cx_px", lens.cx_px, 0, 4096);
  reader.Number("cy_px", lens.cy_px, 0, 4096);
  const auto bend = reader.Numbers("distortion", 5, -10, 10);
  if (!bend.empty()) {
    lens.k1 = bend[0];
    lens.k2 = bend[1];
    lens.p1 = bend[2];
    lens.p2 = bend[3];
    lens.k3 = bend[4];
  }
  if (const std::string problem = sphere::Problem(lens); !problem.empty()) reader.Fail("", problem);
}

void ReadSensor(Reader& reader, CameraFile& camera) {
  sphere::Profile& profile = camera.settings.profile;
  sphere::PixelNoise& noise = camera.settings.noise;
  if (const std::string format = reader.Text("format"); format == "YUYV") {
    camera.format = sphere::PixelFormat::kYuyv;
    // What demosaicing does to a pixel; measured blur and noise belong into the file.
    profile.blur_px = 1.15;
    profile.blur_sd_px = 0.1;
    noise.correlation = 3;
  } else if (!format.empty() && format != "SGRBG8") {
    reader.Fail("format", "must be SGRBG8 or YUYV");
  }
  reader.Number("rate_hz", camera.rate_hz, 1, 1000);
  reader.Number("readout_s", camera.readout_s, 0, 1);
  if (camera.readout_s * camera.rate_hz > 1) {
    reader.Fail("readout_s", "must be at most the time between frames, 1 / rate_hz");
  }
  reader.Number("exposure_s", camera.settings.shutter.exposure_s, 1e-5, 1);
  camera.settings.shutter.row_s = camera.readout_s / (camera.lens.height - 1);
  camera.settings.shutter.period_s = 1 / camera.rate_hz;
  reader.Number("blur_px", profile.blur_px, 0.3, 5);
  reader.Number("blur_sd_px", profile.blur_sd_px, 0.001, 1);
  reader.Number("limb", profile.limb, -0.5, 0.9);
  reader.Number("limb_sd", profile.limb_sd, 0.001, 1);
  reader.Number("read_noise_dn", noise.read_dn, 0.1, 50);
  reader.Number("dn_per_electron", noise.dn_per_electron, 0, 10);
  reader.Number("noise_correlation", noise.correlation, 1, 20);
}

void ReadPose(Reader& reader, CameraFile& camera) {
  const auto position = reader.Numbers("position_W_m", 3, -10, 10);
  const auto turn = reader.Numbers("rotation_WC", 4, -1, 1);
  if (position.empty() != turn.empty()) {
    reader.Fail("rotation_WC", "position_W_m and rotation_WC (w, x, y, z) belong together");
  } else if (!turn.empty()) {
    const Eigen::Quaterniond q(turn[0], turn[1], turn[2], turn[3]);
    if (std::abs(q.norm() - 1) > 0.01) reader.Fail("rotation_WC", "must have the length 1");
    camera.X_WC = Eigen::Isometry3d::Identity();
    camera.X_WC->linear() = q.normalized().toRotationMatrix();
    camera.X_WC->translation() << position[0], position[1], position[2];
  }
  camera.calibrated = reader.Text("calibrated");
}

Result<CameraFile> Parse(const std::string& text, const std::string& origin, bool with_spheres) {
  const auto read = text::ParseJson(text, origin);
  if (!read) return read.error();
  const auto& object = *read;
  CameraFile camera;
  Reader reader(object, origin);
  ReadLens(reader, camera.lens);
  ReadSensor(reader, camera);
  ReadPose(reader, camera);
  const json* spheres = reader.Find("spheres");
  const bool is_missing = spheres == nullptr && !with_spheres;
  if (!is_missing &&
      (spheres == nullptr || !spheres->is_array() || spheres->empty() || spheres->size() > 3)) {
    reader.Fail("spheres", "must be a list of 1 to 3 spheres; footing-camera calibrate writes it");
  }
  if (const std::string problem = reader.Problem(); !problem.empty()) return InvalidData(problem);
  for (std::size_t i = 0; !is_missing && i < spheres->size(); ++i) {
    const auto held = ReadSphere((*spheres)[i], origin + ", sphere " + std::to_string(i + 1));
    if (!held) return held.error();
    camera.spheres.push_back(*held);
  }
  if (const std::string problem = Confusable(camera.spheres); !problem.empty()) {
    return InvalidData(origin + ", " + problem);
  }
  return camera;
}

}  // namespace

std::vector<sphere::Target> CameraFile::Targets() const {
  std::vector<sphere::Target> targets;
  for (const HeldSphere& held : spheres) targets.push_back(held.target);
  return targets;
}

double CameraFile::RowTime(double row_px) const {
  return readout_s * (row_px / (lens.height - 1) - 0.5);
}

Result<CameraFile> ParseCameraFile(const std::string& text, const std::string& origin) {
  return Parse(text, origin, true);
}

Result<CameraFile> ReadCameraFile(const std::string& path) {
  const auto text = config::ReadTextFile(path);
  if (!text) return text.error();
  return ParseCameraFile(*text, path);
}

Result<CameraFile> ReadUncalibratedCamera(const std::string& path) {
  std::error_code none;
  if (!std::filesystem::exists(path, none)) return CameraFile();
  const auto text = config::ReadTextFile(path);
  if (!text) return text.error();
  return Parse(*text, path, false);
}

}  // namespace footing::frames
