#include "common/frames/camera_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "common/base/json_text.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/runtime/files.h"

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

  /// Problem of all that was read; call it last.
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
    // Effects of demosaicing on a pixel; measured blur and noise belong into the file.
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

std::optional<std::uint32_t> ParseColour(const std::string& text) {
  if (text.size() != 7 || text[0] != '#') return std::nullopt;
  std::uint32_t rgb = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + 1, end, rgb, 16);
  if (error != std::errc() || stop != end) return std::nullopt;
  return rgb;
}

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

namespace {

constexpr std::size_t kMostHeaderBytes = 4096;
constexpr std::string_view kTime = " time_ns ";

struct Header {
  bool is_colour = false;
  std::array<int, 3> numbers{};  // Width, height, largest value.
  std::optional<std::int64_t> time_ns;
  std::size_t bytes = 0;
};

bool IsBlank(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

/// A whole header at the start of the text; nothing when it is not all there.
Result<std::optional<Header>> ReadHeader(std::string_view text) {
  const Error no_image = InvalidData("frame: not a binary PGM or PPM image (P5 or P6, 8 bits)");
  if (text.size() < 2) return std::optional<Header>();
  if (text[0] != 'P' || (text[1] != '5' && text[1] != '6')) return no_image;
  Header header;
  header.is_colour = text[1] == '6';
  std::size_t at = 2, count = 0;
  while (count < 3) {
    while (at < text.size() && IsBlank(text[at])) ++at;
    if (at < text.size() && text[at] == '#') {
      const std::size_t end = text.find('\n', at);
      if (end == std::string_view::npos) break;
      const std::string_view comment = text.substr(at + 1, end - at - 1);
      std::int64_t time_ns = 0;
      if (comment.starts_with(kTime) &&
          std::from_chars(comment.data() + kTime.size(), comment.data() + comment.size(), time_ns)
                  .ec == std::errc())
        header.time_ns = time_ns;
      at = end + 1;
      continue;
    }
    const char* end = text.data() + text.size();
    const auto [next, error] = std::from_chars(text.data() + at, end, header.numbers[count]);
    if (next == end) break;
    if (error != std::errc() || !IsBlank(*next)) return no_image;
    at = static_cast<std::size_t>(next - text.data());
    ++count;
  }
  if (count < 3) {
    if (text.size() > kMostHeaderBytes) return no_image;
    return std::optional<Header>();
  }
  header.bytes = at + 1;
  for (std::size_t i = 0; i < 2; ++i) {
    const int size = header.numbers[i];
    if (size < 32 || size > 4096 || size % 2 != 0)
      return InvalidData("frame: sizes must be even, from 32 to 4096, not " + std::to_string(size));
  }
  if (header.numbers[2] != 255) return InvalidData("frame: the largest value must be 255");
  return std::optional<Header>(header);
}

}  // namespace

Result<std::optional<Frame>> NetpbmReader::Next() {
  // Images of a FIFO may be parted by line ends.
  const std::size_t first = pending_.find_first_not_of("\n\r");
  pending_.erase(0, first == std::string::npos ? pending_.size() : first);
  const auto header = ReadHeader(pending_);
  if (!header) return header.error();
  if (!*header) return std::optional<Frame>();
  const Header& head = **header;
  Frame frame;
  frame.width = head.numbers[0];
  frame.height = head.numbers[1];
  frame.time_ns = head.time_ns;
  const auto pixels =
      static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
  const std::size_t size = pixels * (head.is_colour ? 3 : 1);
  if (pending_.size() < head.bytes + size) return std::optional<Frame>();
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(pending_.data() + head.bytes);
  if (!head.is_colour) {
    frame.bytes.assign(bytes, bytes + pixels);
  } else {
    frame.bytes.reserve(pixels);
    for (int v = 0; v < frame.height; ++v) {
      for (int u = 0; u < frame.width; ++u, bytes += 3)
        frame.bytes.push_back(bytes[frame.View().Channel(u, v)]);
    }
  }
  pending_.erase(0, head.bytes + size);
  return std::optional<Frame>(std::move(frame));
}

std::string ToPgm(const Frame& frame) {
  std::string text = "P5\n";
  if (frame.time_ns) text += "#" + std::string(kTime) + std::to_string(*frame.time_ns) + "\n";
  text += std::to_string(frame.width) + " " + std::to_string(frame.height) + "\n255\n";
  return text.append(frame.bytes.begin(), frame.bytes.end());
}

namespace {

constexpr std::size_t kMostBytes = 64u << 20;

}  // namespace

Result<std::vector<std::string>> FramesOf(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string kind = entry.path().extension();
    if (kind == ".pgm" || kind == ".ppm" || kind == ".yuyv") paths.push_back(entry.path());
  }
  if (error) return Failure("cannot read folder " + folder + ": " + error.message());
  if (paths.empty())
    return InvalidData(folder + " holds no frames; it must have .pgm, .ppm or .yuyv files");
  std::sort(paths.begin(), paths.end());
  return paths;
}

Result<Frame> ReadFrame(const std::string& path, int width, int height) {
  const auto text = config::ReadTextFile(path, kMostBytes);
  if (!text) return text.error();
  if (path.ends_with(".yuyv")) {
    Frame frame{sphere::PixelFormat::kYuyv, width, height, {text->begin(), text->end()}, {}};
    const std::size_t size = 2 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (frame.bytes.size() != size)
      return InvalidData(path + ": has " + std::to_string(frame.bytes.size()) +
                         " bytes, must have " + std::to_string(size));
    return frame;
  }
  NetpbmReader reader;
  reader.Add(*text);
  auto frame = reader.Next();
  if (!frame) return InvalidData(path + ": " + frame.error().message);
  if (!*frame) return InvalidData(path + ": ends before its image does");
  if ((**frame).width != width || (**frame).height != height)
    return InvalidData(path + ": its size is not that of the camera file");
  return std::move(**frame);
}

}  // namespace footing::frames
