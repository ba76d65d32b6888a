#include "daemon/offline/eval/momentum.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/cli/cli.h"
#include "common/virtual/devices/scene.h"
#include "common/virtual/options/load.h"
#include "common/virtual/options/sensor_options.h"
#include "daemon/offline/analysis/angle_score.h"
#include "daemon/offline/analysis/pose_metrics.h"
#include "daemon/offline/eval/report.h"
#include "daemon/simulation/momentum/best_estimator.h"
#include "daemon/simulation/momentum/paper_estimator.h"

namespace footing::eval {
namespace {

namespace sensors = virtual_sensors;

double YawOf(const sensors::BodyCourse& course, std::size_t foot) {
  const Eigen::Vector3d ahead = course.sole_m[foot][2].col(0) + course.sole_m[foot][3].col(0) -
                                course.sole_m[foot][0].col(0) - course.sole_m[foot][1].col(0);
  return std::atan2(ahead.y(), ahead.x());
}

/// The clip after the person has stood still.
Result<sensors::Scene> Load(const MomentumOptions& options) {
  auto read = motion_files::LoadMotion(
      options.motion, {.skeleton = options.skeleton, .bvh_unit_m = options.bvh_unit_m});
  if (!read) return read.error();
  body::PersonParameters person;
  person.mass_kg = options.mass_kg;
  person.height_m = read->height_m;
  sensors::SceneOptions clip;
  clip.hold_s = kCalibrationS;
  clip.rest_share = momentum::FootShape{}.rest_share;
  clip.loop_s = 60 * options.loop_minutes;
  return sensors::MakeScene(std::move(read->motion), person, clip, options.motion);
}

}  // namespace

Result<MomentumScene> MakeMomentumScene(const MomentumOptions& options) {
  const auto made = Load(options);
  if (!made) return made.error();
  const motion::Motion& motion = made->motion;
  const sensors::BodyCourse& course = made->course;

  MomentumScene scene;
  scene.rate_hz = options.rate_hz;
  scene.subject.com_height_m = course.com_m(2, 0);
  std::array<sensors::BoardPlace, sensors::kFeet> boards = sensors::SideBySide();
  std::vector<sensors::CellErrors> cells;
  for (std::size_t f = 0; f < sensors::kFeet; ++f) {
    scene.subject.feet[f].yaw_rad = YawOf(course, f);
    // Each foot begins in its board's middle.
    boards[f].middle_m = sensors::SoleMiddle(course, f, 0).head<2>();
    sensors::CellErrorConfig errors = options.errors;
    errors.seed = 2 * options.errors.seed + f;
    cells.emplace_back(errors);
  }
  const double step_s = 1 / options.rate_hz;
  const auto frames = static_cast<std::size_t>(motion.duration_s() * options.rate_hz);
  std::size_t loaded = 0, outside = 0;
  for (std::size_t i = 0; i < frames; ++i) {
    const auto at = std::min<Eigen::Index>(
        static_cast<Eigen::Index>(std::lround(static_cast<double>(i) * step_s * motion.rate_hz)),
        motion.frames() - 1);
    const auto feet = sensors::ShareBetweenFeet(course, made->reaction, at);
    MomentumFrame frame;
    frame.loads.time_s = static_cast<double>(i) * step_s;
    frame.com_m = course.com_m.col(at);
    frame.angular_momentum = course.angular_momentum.col(at);
    for (std::size_t f = 0; f < sensors::kFeet; ++f) {
      const auto load = sensors::LoadBoard(boards[f], feet[f], !options.unlimited);
      const auto read_n = cells[f].Advance(load.corners_n, step_s);
      const auto places = sensors::SensorPlaces(boards[f]);
      momentum::FootLoads& foot = frame.loads.feet[f];
      foot.valid = true;
      foot.count = places.size();
      for (std::size_t k = 0; k < places.size(); ++k)
        foot.cells[k] = {{places[k].x(), places[k].y(), 0}, read_n[k]};
      frame.feet[f].load_n = feet[f].load_n;
      frame.feet[f].middle_m = sensors::SoleMiddle(course, f, at);
      if (feet[f].load_n > 20) {
        ++loaded;
        outside += load.outside ? 1 : 0;
      }
    }
    scene.frames.push_back(frame);
  }
  scene.outside_share = loaded > 0 ? static_cast<double>(outside) / static_cast<double>(loaded) : 0;
  return scene;
}

using nlohmann::ordered_json;

ordered_json OfflineJson(const MomentumScene& scene, const momentum::TPose& pose, std::size_t start,
                         std::size_t judged) {
  const double step_s = 1 / scene.rate_hz;
  std::vector<momentum::VerticalInput> vertical;
  for (std::size_t i = start; i < scene.frames.size(); ++i)
    vertical.push_back(momentum::ToVerticalInput(
        scene.frames[i].loads, momentum::PressureOf(scene.frames[i].loads, kContactN)));
  const auto height = momentum::SmoothHeight(pose.mass_kg, step_s, scene.subject.arms_hang_m,
                                             pose.cell_noise_n, pose.mean_loads, vertical);
  const std::array<momentum::HorizontalPrior, 2> priors{momentum::ForwardPrior(),
                                                        momentum::LateralPrior()};
  ordered_json out;
  Spread z;
  for (std::size_t i = judged - start; i < height.size(); ++i)
    z.Add(100 * (height[i].mean + scene.subject.com_height_m - scene.frames[start + i].com_m.z()));
  out["com_vertical_rms_cm"] = z.rms();
  for (int axis = 0; axis < 2; ++axis) {
    std::vector<momentum::HorizontalInput> inputs;
    for (std::size_t i = 0; i < vertical.size(); ++i) {
      momentum::HorizontalInput input;
      input.cop_valid = vertical[i].cop_valid;
      input.cop_m = vertical[i].cop_m(axis);
      for (const double load : vertical[i].load_n) input.load_n += load;
      input.com_height_m = scene.subject.com_height_m + height[i].mean;
      input.centre_m = pose.cop_m(axis);
      inputs.push_back(input);
    }
    const auto smooth = momentum::SmoothHorizontal(priors[static_cast<std::size_t>(axis)],
                                                   pose.mass_kg, step_s, pose.cop_m(axis), inputs);
    Spread rms;
    for (std::size_t i = judged - start; i < smooth.size(); ++i)
      rms.Add(100 * (smooth[i].mean - scene.frames[start + i].com_m(axis)));
    out[axis == 0 ? "com_forward_rms_cm" : "com_lateral_rms_cm"] = rms.rms();
  }
  return out;
}

namespace {

/// The T-pose at the scene's beginning, and the first frame after it.
struct CalibratedStart {
  momentum::TPose pose;
  std::size_t frame = 0;
};

Result<CalibratedStart> Calibrate(const MomentumScene& scene, const std::string& motion) {
  momentum::TPoseCalibration calibration;
  for (std::size_t i = 0; i < scene.frames.size(); ++i) {
    if (!calibration.Advance(scene.frames[i].loads, 1 / scene.rate_hz)) continue;
    return CalibratedStart{calibration.result(), i + 1};
  }
  return InvalidData(motion +
                     ": no T-pose could be taken: the body never stands still with both feet on "
                     "the boards before the motion; use a clip that begins in place, or "
                     "--unlimited");
}

momentum::BestConfig BestConfigOf(const MomentumOptions& options) {
  momentum::BestConfig config;
  config.lag_s = options.lag_s;
  return config;
}

/// The estimator of either mode, and the time that it takes.
class TimedEstimator {
 public:
  TimedEstimator(const MomentumOptions& options, const momentum::Subject& subject,
                 const momentum::TPose& pose, double step_s)
      : paper_mode_(options.paper),
        contacts_(subject, pose, step_s),
        best_(BestConfigOf(options), subject, pose, step_s),
        paper_({}, subject, pose, step_s) {}

  const momentum::Estimate& Advance(const momentum::ContactLoads& loads) {
    const auto began = std::chrono::steady_clock::now();
    const momentum::Estimate& estimate =
        paper_mode_ ? paper_.Advance(loads, std::nullopt) : best_.Advance(contacts_.Advance(loads));
    busy_s_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    return estimate;
  }
  double busy_s() const { return busy_s_; }

 private:
  const bool paper_mode_;
  momentum::ContactEstimator contacts_;
  momentum::BestEstimator best_;
  momentum::PaperEstimator paper_;
  double busy_s_ = 0;
};

Result<ordered_json> Evaluate(const MomentumOptions& options, bool offline) {
  const auto scene = MakeMomentumScene(options);
  if (!scene) return scene.error();
  const auto start = Calibrate(*scene, options.motion);
  if (!start) return start.error();
  const double step_s = 1 / scene->rate_hz;
  const auto lag = static_cast<std::size_t>(std::lround(options.lag_s / step_s));
  TimedEstimator estimator(options, scene->subject, start->pose, step_s);
  MomentumScore score(*scene, start->pose, start->frame);
  for (std::size_t i = start->frame; i < scene->frames.size(); ++i) {
    score.Add(i, i - lag, estimator.Advance(scene->frames[i].loads));
  }
  ordered_json out;
  out["frames"] = score.frames();
  out["rate_hz"] = scene->rate_hz;
  out["mode"] = options.paper ? "paper" : "best";
  out["lag_ms"] = 1000 * static_cast<double>(lag) * step_s;
  out["mass_kg"] = start->pose.mass_kg;
  score.WriteTo(out);
  out["frame_us"] = 1e6 * estimator.busy_s() / static_cast<double>(score.frames());
  if (offline) out["offline"] = OfflineJson(*scene, start->pose, start->frame, start->frame);
  return out;
}

}  // namespace

void AddMomentumCommand(CLI::App& app, Shared& shared) {
  auto* command = app.add_subcommand(
      "momentum",
      "COM, angular momentum and feet estimated from two simulated boards under a motion");
  struct Flags {
    MomentumOptions options;
    double lag_ms = 0;
    std::string mode = "best";
    bool offline = false;
  };
  const auto flags = std::make_shared<Flags>();
  MomentumOptions& options = flags->options;
  command
      ->add_option("--motion", options.motion, "Motion file: BVH, AMC with --skeleton, TRC or C3D")
      ->required();
  sensor_options::AddMotionFile(*command, options.skeleton, options.bvh_unit_m);
  command->add_option("--mass-kg", options.mass_kg, "Mass of the body, kg")
      ->check(CLI::Range(20.0, 250.0));
  command->add_option("--mode", flags->mode, "Reconstruction mode: paper or best")
      ->check(CLI::IsMember({"paper", "best"}));
  command->add_option("--lag-ms", flags->lag_ms, "Output delay for smoothing, ms, 0 to 200")
      ->check(CLI::Range(0.0, 200.0));
  command
      ->add_option(
          "--loop-minutes", options.loop_minutes,
          "Total duration, min: the motion is played forwards and backwards until then (0: once)")
      ->check(CLI::Range(0.0, 60.0));
  sensor_options::AddBoardErrors(*command, options.errors);
  command->add_option("--seed", options.errors.seed, "Seed of the sensor errors");
  command->add_flag("--unlimited", options.unlimited, "Simulate boards of unlimited size");
  command->add_flag("--offline", flags->offline, "Run the offline smoothers as well");
  command->callback([flags, &shared] {
    flags->options.lag_s = flags->lag_ms / 1000;
    flags->options.paper = flags->mode == "paper";
    if (flags->options.paper && flags->lag_ms > 0) {
      shared.exit_code =
          cli::Report(UsageError("--lag-ms does not apply to --mode paper, which has no lag"));
      return;
    }
    shared.exit_code = PrintResult(Evaluate(flags->options, flags->offline), shared.json);
  });
}

using momentum::kFeet;

double Rms::value() const { return count_ > 0 ? std::sqrt(sum_ / static_cast<double>(count_)) : 0; }

MomentumScore::MomentumScore(const MomentumScene& scene, const momentum::TPose& pose,
                             std::size_t start)
    : scene_(scene), start_(start), step_s_(1 / scene.rate_hz) {
  for (std::size_t f = 0; f < kFeet; ++f) {
    rest_m_[f] = scene.frames[0].feet[f].middle_m - pose.p_WP_m[f];
  }
}

void MomentumScore::Add(std::size_t now, std::size_t then, const momentum::Estimate& estimate) {
  const MomentumFrame& truth = scene_.frames[now];
  ++frames_;
  AddCom(now, estimate, scene_.frames[then].com_m);
  AddCentreOfPressure(truth);
  AddAngularMomentum(truth, estimate);
  AddFeet(truth, estimate);
}

void MomentumScore::AddCom(std::size_t now, const momentum::Estimate& estimate,
                           const Eigen::Vector3d& com_m) {
  const auto minute = static_cast<std::size_t>(60 / step_s_);
  const Eigen::Vector3d error = estimate.p_WC_m - com_m;
  finite_ = finite_ && error.allFinite() && estimate.angular_momentum_kgm2ps.allFinite();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    com_[axis].Add(error(static_cast<Eigen::Index>(axis)));
  }
  if (now < start_ + minute) first_minute_.Add(error.z());
  if (now + minute >= scene_.frames.size()) last_minute_.Add(error.z());
  nees_ += error.z() * error.z() / estimate.position_variance_m2.z();
}

void MomentumScore::AddCentreOfPressure(const MomentumFrame& truth) {
  const auto cop = PressureOf(truth.loads, 100);
  if (!cop.cop_valid) return;
  cop_[0].Add(cop.p_WP_m.x() - truth.com_m.x());
  cop_[1].Add(cop.p_WP_m.y() - truth.com_m.y());
}

void MomentumScore::AddAngularMomentum(const MomentumFrame& truth,
                                       const momentum::Estimate& estimate) {
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    angular_error_[k].Add(estimate.angular_momentum_kgm2ps(axis) - truth.angular_momentum(axis));
    angular_true_[k].Add(truth.angular_momentum(axis));
  }
}

void MomentumScore::AddFeet(const MomentumFrame& truth, const momentum::Estimate& estimate) {
  for (std::size_t f = 0; f < kFeet; ++f) {
    contacts_.Add(f, truth.feet[f].load_n > kContactN, estimate.feet[f].contact, step_s_);
    if (contacts_.true_since_s[f] <= kSettledContactS) continue;
    const Eigen::Vector3d p_W_m = estimate.feet[f].p_WF_m + rest_m_[f];
    foot_position_.Add((p_W_m - truth.feet[f].middle_m).head<2>().norm());
  }
}

void MomentumScore::WriteTo(nlohmann::ordered_json& out) const {
  out["finite"] = finite_;
  out["cop_outside_sensors_share"] = scene_.outside_share;
  out["com_forward_rms_cm"] = com_[0].centimetres();
  out["com_lateral_rms_cm"] = com_[1].centimetres();
  out["com_horizontal_rms_cm"] = std::hypot(com_[0].centimetres(), com_[1].centimetres());
  out["com_vertical_rms_cm"] = com_[2].centimetres();
  out["com_vertical_first_minute_rms_cm"] = first_minute_.centimetres();
  out["com_vertical_last_minute_rms_cm"] = last_minute_.centimetres();
  out["com_vertical_nees"] = nees_ / static_cast<double>(frames_);
  out["cop_forward_rms_cm"] = cop_[0].centimetres();
  out["cop_lateral_rms_cm"] = cop_[1].centimetres();
  out["foot_position_rms_cm"] = foot_position_.centimetres();
  out["contact_f1"] = contacts_.F1();
  out["landings"] = contacts_.landings;
  out["landing_delay_ms"] = 1000 * contacts_.mean_delay_s();
  out["landing_delay_worst_ms"] = 1000 * contacts_.worst_delay_s;
  nlohmann::ordered_json& angular = out["angular_momentum_error_kgm2ps"];
  for (std::size_t k = 0; k < 3; ++k) {
    angular.push_back({{"error", angular_error_[k].value()}, {"true", angular_true_[k].value()}});
  }
}

}  // namespace footing::eval
