#include "daemon/offline/eval/sphere.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <numbers>

#include <Eigen/Core>
#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "common/base/text.h"
#include "common/frames/camera_file.h"
#include "common/runtime/clock.h"
#include "common/virtual/camera/render.h"
#include "common/virtual/camera/scene.h"
#include "daemon/offline/eval/report.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;
namespace camera = virtual_camera;

const Eigen::Vector3d kColours[] = {{170, 40, 150}, {40, 170, 160}};

constexpr int kFramesPerReport = 500;

double RadiusPx(const camera::Scene& scene, const camera::Ball& ball) {
  return scene.lens.fx_px * ball.radius_m / ball.p_C_m.z();
}

/// Two balls that do not cover each other.
void PlaceBalls(camera::Scene& scene, double depth_m, noise::Random& random) {
  for (const Eigen::Vector3d& colour : kColours) {
    camera::Ball ball;
    ball.colour_dn = colour;
    do {
      ball.p_C_m = camera::PlaceInView(scene.lens, depth_m, 0.8, random);
    } while (!scene.balls.empty() && (camera::Project(scene.lens, ball.p_C_m) -
                                      camera::Project(scene.lens, scene.balls[0].p_C_m))
                                             .norm() < 2.5 * RadiusPx(scene, ball) + 10);
    scene.balls.push_back(ball);
  }
}

/// Hands that swing to and fro in front of the camera, at 60 frames a second: 2 m/s at 2 m.
void Swing(camera::Scene& scene, double depth_m, int frame) {
  constexpr double kTwoPi = 2 * std::numbers::pi;
  const Eigen::Array3d rate_hz(0.9, 0.7, 0.5), reach(0.2, 0.15, 0.1);
  const double t_s = frame / 60.0;
  for (std::size_t i = 0; i < scene.balls.size(); ++i) {
    const double side = i == 0 ? -0.3 : 0.3;
    const Eigen::Array3d phase = kTwoPi * rate_hz * t_s + side * Eigen::Array3d(3, 6, 9);
    scene.balls[i].p_C_m = depth_m * (Eigen::Array3d(side, 0, 1) + reach * phase.sin()).matrix();
    scene.balls[i].v_C_mps = depth_m * (kTwoPi * rate_hz * reach * phase.cos()).matrix();
  }
}

/// Applies the permanent effects of a condition, for the calibration too.
void ApplyOptics(const std::string& condition, camera::Scene& scene) {
  if (condition == "soft") scene.sensor.psf_px = 1.6;
  if (condition == "dim") scene.sensor.read_noise_dn = 3;
  if (condition == "bent_lens") {
    scene.lens.k1 = -0.12;
    scene.lens.k2 = 0.02;
    scene.lens.cx_px += 4;
    scene.lens.cy_px -= 3;
  }
  for (camera::Ball& ball : scene.balls) {
    if (condition == "dim") ball.colour_dn *= 70.0 / 170;
    if (condition == "other_limb") ball.limb_power = 0.15;
    if (condition == "saturated") {
      ball.colour_dn *= 1.65;
      ball.halo = 0.08;
    }
  }
}

/// Applies the effects of a condition on one frame.
void ApplyEvents(const std::string& condition, camera::Scene& scene, noise::Random& random) {
  if (condition == "clutter" || condition == "absent" || condition == "lamp")
    camera::AddClutter(scene, 40, random);
  if (condition == "absent") scene.balls.clear();
  for (std::size_t i = 0; i < scene.balls.size(); ++i) {
    if (condition == "moving") scene.balls[i].v_C_mps = {1.4, 1.4, 0.3};
    // One line would hide the other ball too: one of them is hidden, in turn.
    if (i == 0 && condition == "quarter_hidden")
      scene.occluders.push_back(camera::Hide(scene, scene.balls[i], 0.25, random));
    if (i == 0 && condition == "half_hidden")
      scene.occluders.push_back(camera::Hide(scene, scene.balls[i], 0.5, random));
  }
  if (!scene.occluders.empty()) scene.balls.resize(1);
}

camera::Scene MakeScene(const std::string& condition, double depth_m, noise::Random& random) {
  camera::Scene scene;
  ApplyOptics(condition, scene);
  PlaceBalls(scene, depth_m, random);
  ApplyOptics(condition, scene);
  return scene;
}

/// A ball lies across the edge of the lamp, which is the last of the clutter, or nearly so.
bool IsAtLamp(const camera::Scene& scene) {
  constexpr double kNearlyPx = 3;
  const camera::Shape& lamp = scene.shapes.back();
  return std::any_of(scene.balls.begin(), scene.balls.end(), [&](const camera::Ball& ball) {
    const Eigen::Vector2d from = Eigen::Rotation2Dd(-lamp.turn_rad) *
                                 (camera::Project(scene.lens, ball.p_C_m) - lamp.centre_px);
    const double beyond_px =
        (from.cwiseQuotient(lamp.half_px).norm() - 1) * lamp.half_px.minCoeff();
    return std::abs(beyond_px) < RadiusPx(scene, ball) + kNearlyPx;
  });
}

/// The next frame's.
camera::Scene NextScene(const SphereTrial& trial, int frame, noise::Random& random) {
  for (;;) {
    const double depth_m = trial.distance_m > 0 ? trial.distance_m : random.Uniform(0.5, 4);
    camera::Scene scene = MakeScene(trial.condition, depth_m, random);
    if (trial.condition == "tracked") Swing(scene, depth_m, frame);
    ApplyEvents(trial.condition, scene, random);
    if (trial.condition != "lamp" || IsAtLamp(scene)) return scene;
  }
}

frames::Frame FrameOf(const camera::Mosaic& mosaic, bool is_yuyv) {
  frames::Frame frame{sphere::PixelFormat::kSgrbg8, mosaic.width, mosaic.height, mosaic.bytes, {}};
  if (is_yuyv) {
    frame.format = sphere::PixelFormat::kYuyv;
    frame.bytes = camera::ToYuyv(mosaic);
  }
  return frame;
}

/// Frames, their truth and the camera file in a folder.
class TruthWriter {
 public:
  Result<void> Open(const std::string& folder, const frames::CameraFile& file) {
    folder_ = folder;
    if (folder.empty()) return {};
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    std::ofstream(folder + "/camera.json") << frames::ToJson(file);
    truth_.open(folder + "/truth.csv");
    truth_ << "frame,role,t_s,x_m,y_m,z_m\n";
    if (error || !truth_) return Failure("cannot write into " + folder);
    return {};
  }

  void Add(int index, frames::Frame frame, const camera::Scene& scene,
           const frames::CameraFile& file) {
    if (folder_.empty()) return;
    const bool is_yuyv = frame.format == sphere::PixelFormat::kYuyv;
    std::string number = std::to_string(index);
    number.insert(0, 6 - std::min<std::size_t>(6, number.size()), '0');
    const std::string name = number + (is_yuyv ? ".yuyv" : ".pgm");
    const double t_s = index / file.rate_hz;
    frame.time_ns = static_cast<std::int64_t>(std::llround(1e9 * t_s));
    std::ofstream out(folder_ + "/" + name, std::ios::binary);
    if (is_yuyv) {
      out.write(reinterpret_cast<const char*>(frame.bytes.data()),
                static_cast<std::streamsize>(frame.bytes.size()));
    } else {
      out << frames::ToPgm(frame);
    }
    for (std::size_t i = 0; i < scene.balls.size(); ++i) {
      const auto seen = camera::Truth(scene, scene.balls[i]);
      if (!seen) continue;
      truth_ << name << ',' << stream::Name(file.spheres[i].role) << ',' << t_s + seen->after_s
             << ',' << seen->p_C_m.x() << ',' << seen->p_C_m.y() << ',' << seen->p_C_m.z() << '\n';
    }
  }

 private:
  std::string folder_;
  std::ofstream truth_;
};

frames::CameraFile KnownCamera(const std::string& condition) {
  camera::Scene scene;
  ApplyOptics(condition, scene);
  const camera::Lens& lens = scene.lens;
  frames::CameraFile file;
  file.lens = {lens.width, lens.height, lens.fx_px, lens.fy_px, lens.cx_px, lens.cy_px,
               lens.k1,    lens.k2,     lens.p1,    lens.p2,    lens.k3};
  file.settings.noise.read_dn = scene.sensor.read_noise_dn;
  file.settings.noise.dn_per_electron = scene.sensor.dn_per_electron;
  file.readout_s = scene.sensor.readout_s;
  file.settings.shutter.exposure_s = scene.sensor.exposure_s;
  file.settings.shutter.row_s = file.readout_s / (lens.height - 1);
  if (condition == "yuyv") {
    file.format = sphere::PixelFormat::kYuyv;
    file.settings.noise.correlation = 3;
  }
  const double share = condition == "dim" ? 70.0 / 170 : 1;
  for (int i = 0; i < 2; ++i) {
    frames::HeldSphere held;
    held.role = i == 0 ? stream::DeviceRole::kLeftHand : stream::DeviceRole::kRightHand;
    held.target.colour_dn = share * kColours[i];
    file.spheres.push_back(held);
  }
  return file;
}

}  // namespace

double RateBound(int events, int trials) {
  if (trials <= 0) return 1;
  if (events > 100) return std::min(1.0, (events + 1.645 * std::sqrt(events) + 2) / trials);
  // Poisson's law: the mean at which so few events or fewer have a probability of 5 %.
  double low = 0, high = 10 + 3.0 * events;
  for (int i = 0; i < 60; ++i) {
    const double mean = 0.5 * (low + high);
    double term = std::exp(-mean), sum = term;
    for (int k = 1; k <= events; ++k) sum += term *= mean / k;
    (sum > 0.05 ? low : high) = mean;
  }
  return std::min(1.0, high / trials);
}

const std::vector<std::string>& SphereConditions() {
  static const std::vector<std::string> kConditions = {
      "nominal", "dim",  "soft",      "saturated",  "moving", "quarter_hidden", "half_hidden",
      "clutter", "yuyv", "bent_lens", "other_limb", "absent", "tracked",        "lamp"};
  return kConditions;
}

Result<frames::CameraFile> CalibratedCamera(const std::string& condition, std::uint64_t seed) {
  constexpr int kFrames = 24;
  frames::CameraFile file = KnownCamera(condition);
  noise::Random random(seed + 1'000'000);
  sphere::Settings loose = file.settings;
  loose.profile = {1.2, 0.4, 0.2, 0.3};
  sphere::Finder finder(file.lens, file.Targets(), loose);
  std::vector<sphere::Estimate> estimates;
  for (int i = 0; i < kFrames; ++i) {
    const camera::Scene scene = MakeScene(condition, 0.6 + 0.6 * i / kFrames, random);
    const auto frame = FrameOf(camera::Render(scene, random), condition == "yuyv");
    for (const auto& found : finder.Find(frame.View()))
      if (found) estimates.push_back(*found);
  }
  const auto profile = sphere::Calibrate(estimates);
  if (!profile) return Failure("calibration: the spheres are seen in too few frames");
  file.settings.profile = *profile;
  return file;
}

Result<ordered_json> RunSphereTrial(const SphereTrial& trial, const frames::CameraFile& file) {
  noise::Random random(trial.seed * 1000 + static_cast<std::uint64_t>(10 * trial.distance_m));
  sphere::Finder finder(file.lens, file.Targets(), file.settings);
  TruthWriter writer;
  if (const auto opened = writer.Open(trial.out, file); !opened) return opened.error();
  SphereErrors errors;
  EstimateRows rows;
  if (const auto opened = rows.Open(trial.rows, trial.condition); !opened) return opened.error();
  const bool is_sequence = trial.condition == "tracked";
  std::vector<double> cost_ms;
  int spheres = 0, extra = 0;
  for (int i = 0; i < trial.frames; ++i) {
    const camera::Scene scene = NextScene(trial, i, random);
    const auto frame = FrameOf(camera::Render(scene, random), trial.condition == "yuyv");
    writer.Add(i, frame, scene, file);
    if (i > 0 && i % kFramesPerReport == 0 && trial.on_progress)
      trial.on_progress({i, spheres, spheres - errors.right(), extra});
    if (!is_sequence) finder.Forget();
    const std::int64_t began_ns = clock::ThreadCpuNs();
    const auto found = finder.Find(frame.View());
    cost_ms.push_back(1e-6 * static_cast<double>(clock::ThreadCpuNs() - began_ns));
    for (std::size_t k = 0; k < found.size(); ++k) {
      const auto seen = k < scene.balls.size() ? camera::Truth(scene, scene.balls[k])
                                               : std::optional<camera::Seen>();
      spheres += seen ? 1 : 0;
      if (found[k] && seen) errors.Add(*found[k], seen->p_C_m);
      if (found[k] || seen) rows.Add(i, k, found[k], seen);
      if (found[k] && !seen && found[k]->confidence > 0.5) ++extra;
    }
  }
  ordered_json row = {{"condition", trial.condition},
                      {"distance_m", trial.distance_m},
                      {"frames", trial.frames},
                      {"spheres", spheres}};
  row.update(errors.Json());
  row["missed_rate_bound95"] = RateBound(spheres - errors.right(), spheres);
  row["false_spheres"] = extra;
  row["false_rate_bound95"] = RateBound(extra, trial.frames);
  row["cost_p50_ms"] = text::Quantile(cost_ms, 0.5);
  row["cost_p99_ms"] = text::Quantile(std::move(cost_ms), 0.99);
  return row;
}

void SphereErrors::Add(const sphere::Estimate& found, const Eigen::Vector3d& truth_m) {
  const Eigen::Vector3d error = found.p_C_m - truth_m, along = truth_m.normalized();
  const double depth = error.dot(along);
  confidence_ += found.confidence;
  ++found_;
  // A wrong place is a false sphere, not an error of measurement.
  if (error.norm() > 0.25 * truth_m.norm()) {
    ++wrong_;
    return;
  }
  depth_mm_.push_back(1000 * depth);
  lateral_mm2_ += 1e6 * (error - depth * along).squaredNorm();
  nees_ += error.dot(found.covariance_m2.ldlt().solve(error)) / 3;
  const double variance_m2 = along.dot(found.covariance_m2 * along);
  depth_nees_ += depth * depth / variance_m2;
  variance_mm2_ += 1e6 * variance_m2;
}

ordered_json SphereErrors::Json() const {
  const double count = std::max<double>(1, static_cast<double>(depth_mm_.size()));
  double bias = 0, square = 0, largest = 0;
  for (const double value : depth_mm_) {
    bias += value / count;
    square += value * value / count;
    largest = std::max(largest, std::abs(value));
  }
  return {{"found", found_},
          {"wrong", wrong_},
          {"lateral_rms_mm", std::sqrt(lateral_mm2_ / count)},
          {"depth_bias_mm", bias},
          {"depth_sd_mm", std::sqrt(std::max(0.0, square - bias * bias))},
          {"depth_sd_reported_mm", std::sqrt(variance_mm2_ / count)},
          {"depth_largest_mm", largest},
          {"nees", nees_ / count},
          {"nees_depth", depth_nees_ / count},
          {"confidence_mean", confidence_ / std::max(1, found_)}};
}

Result<void> EstimateRows::Open(const std::string& path, const std::string& condition) {
  condition_ = condition;
  if (path.empty()) return {};
  file_.open(path, std::ios::app);
  if (!file_) return Failure("cannot write " + path);
  if (file_.tellp() == 0)
    file_ << "condition,frame,sphere,range_m,found,range_found_m,lateral_mm,depth_mm,depth_sd_mm,"
             "nees,"
             "confidence,seen_share,misfit,residual_share,colour_off,radius_px,saturated\n";
  return {};
}

void EstimateRows::Add(int frame, std::size_t sphere, const std::optional<sphere::Estimate>& found,
                       const std::optional<virtual_camera::Seen>& seen) {
  if (!file_.is_open()) return;
  const sphere::Estimate none, &one = found ? *found : none;
  double lateral_mm = 0, depth_mm = 0, sd_mm = 0, nees = 0;
  if (found && seen) {
    const Eigen::Vector3d error = one.p_C_m - seen->p_C_m, along = seen->p_C_m.normalized();
    depth_mm = 1000 * error.dot(along);
    lateral_mm = 1000 * (error - error.dot(along) * along).norm();
    sd_mm = 1000 * std::sqrt(along.dot(one.covariance_m2 * along));
    nees = error.dot(one.covariance_m2.ldlt().solve(error)) / 3;
  }
  file_ << condition_ << ',' << frame << ',' << sphere << ',' << (seen ? seen->p_C_m.norm() : 0)
        << ',' << found.has_value() << ',' << one.p_C_m.norm() << ',' << lateral_mm << ','
        << depth_mm << ',' << sd_mm << ',' << nees << ',' << one.confidence << ',' << one.seen_share
        << ',' << one.misfit << ',' << one.residual_share << ',' << one.colour_off << ','
        << one.radius_px << ',' << one.is_saturated << '\n';
}

namespace {

struct SphereFlags {
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

Result<ordered_json> Evaluate(const SphereFlags& flags) {
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
  const auto flags = std::make_shared<SphereFlags>();
  command->add_option("--frames", flags->frames, "Folder of frames: .pgm, .ppm or .yuyv files")
      ->required();
  command->add_option("--camera", flags->camera, "Camera file, JSON (docs/camera.md)")->required();
  command->callback(
      [flags, &shared] { shared.exit_code = PrintResult(Evaluate(*flags), shared.json); });
}

namespace {

struct TrialFlags {
  SphereTrial trial;
  std::vector<double> distances_m = {0.5, 1, 1.5, 2, 2.5, 3, 4};
  bool with_progress = false;
};

void PrintProgress(const SphereProgress& so_far) {
  std::cerr << so_far.frames << " frames: " << so_far.missed << " of " << so_far.spheres
            << " spheres missed (95 %: below " << RateBound(so_far.missed, so_far.spheres) << "), "
            << so_far.extra << " false ones (95 %: below " << RateBound(so_far.extra, so_far.frames)
            << " a frame)" << std::endl;
}

Result<ordered_json> EvaluateTrials(const TrialFlags& flags) {
  const auto camera = CalibratedCamera(flags.trial.condition, flags.trial.seed);
  if (!camera) return camera.error();
  if (!flags.trial.out.empty() && flags.distances_m.size() != 1)
    return UsageError("--out takes the frames of one distance; name it with --distance-m");
  ordered_json rows = ordered_json::array();
  for (const double distance_m : flags.distances_m) {
    SphereTrial trial = flags.trial;
    trial.distance_m = distance_m;
    if (flags.with_progress) trial.on_progress = PrintProgress;
    const auto row = RunSphereTrial(trial, *camera);
    if (!row) return row.error();
    rows.push_back(*row);
  }
  return ordered_json{{"blur_px", camera->settings.profile.blur_px},
                      {"limb", camera->settings.profile.limb},
                      {"rows", rows}};
}

}  // namespace

void AddSpheresCommand(CLI::App& app, Shared& shared) {
  auto* command = app.add_subcommand(
      "spheres", "Errors of the sphere finder on rendered frames, by distance and condition");
  const auto flags = std::make_shared<TrialFlags>();
  SphereTrial& trial = flags->trial;
  command->add_option("--condition", trial.condition, "Light, lens and surroundings")
      ->check(CLI::IsMember(SphereConditions()));
  command
      ->add_option("--distance-m", flags->distances_m,
                   "Distances of the spheres, m; 0 draws each from 0.5 to 4")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 10.0));
  command->add_option("--frames", trial.frames, "Frames per distance")
      ->check(CLI::Range(1, 1000000));
  command->add_option("--seed", trial.seed, "Seed of places, noise and clutter");
  command->add_option("--rows", trial.rows,
                      "CSV file to add a row to for every sphere that is there or is found");
  command->add_option("--out", trial.out,
                      "Folder to write the frames, truth.csv and camera.json into");
  command->add_flag("--progress", flags->with_progress,
                    "Counts and rates so far on standard error, every 500 frames");
  command->callback(
      [flags, &shared] { shared.exit_code = PrintResult(EvaluateTrials(*flags), shared.json); });
}

}  // namespace footing::eval
