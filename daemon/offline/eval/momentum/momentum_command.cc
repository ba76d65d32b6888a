#include "daemon/offline/eval/momentum/momentum_command.h"

#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/cli/cli.h"
#include "daemon/offline/eval/momentum/offline.h"
#include "daemon/offline/eval/momentum/scene.h"
#include "daemon/offline/eval/report/print_report.h"
#include "daemon/offline/eval/scores/contact_score.h"
#include "daemon/simulation/momentum/best_estimator.h"
#include "daemon/simulation/momentum/paper_estimator.h"

namespace footing::eval {
namespace {

using momentum::kFeet;
using nlohmann::ordered_json;

class Rms {
 public:
  void Add(double error) {
    sum_ += error * error;
    ++count_;
  }
  double value() const { return count_ > 0 ? std::sqrt(sum_ / static_cast<double>(count_)) : 0; }
  double centimetres() const { return 100 * value(); }

 private:
  double sum_ = 0;
  std::size_t count_ = 0;
};

Result<ordered_json> Evaluate(const MomentumOptions& options, bool offline) {
  const auto scene = MakeMomentumScene(options);
  if (!scene) return scene.error();
  const double step_s = 1 / scene->rate_hz;
  momentum::TPoseCalibration calibration;
  std::size_t start = 0;
  while (start < scene->frames.size() && !calibration.Advance(scene->frames[start].loads, step_s))
    ++start;
  if (!calibration.complete())
    return InvalidData(options.motion + ": its T-pose never stood still on both boards");
  ++start;
  const momentum::TPose& pose = calibration.result();
  momentum::BestConfig config;
  config.lag_s = options.lag_s;
  momentum::BestEstimator best(config, scene->subject, pose, step_s);
  momentum::PaperEstimator paper({}, scene->subject, pose, step_s);

  std::array<Eigen::Vector3d, kFeet>
      rest;  // From the place of the COP at rest to the sole's middle.
  for (std::size_t f = 0; f < kFeet; ++f)
    rest[f] = scene->frames[0].feet[f].middle_m - pose.p_WP_m[f];
  Rms forward, lateral, vertical, first_minute, last_minute, cop_forward, cop_lateral, place;
  std::array<Rms, 3> momentum_error, momentum_true;
  ContactScore contacts;
  double nees = 0, busy_s = 0;
  std::size_t judged = 0;
  bool finite = true;
  const auto lag = static_cast<std::size_t>(std::lround(options.lag_s / step_s));
  const auto minute = static_cast<std::size_t>(60 / step_s);
  for (std::size_t i = start; i < scene->frames.size(); ++i) {
    const MomentumFrame& now = scene->frames[i];
    const auto began = std::chrono::steady_clock::now();
    const momentum::Estimate& told =
        options.paper ? paper.Advance(now.loads, std::nullopt) : best.Advance(now.loads);
    busy_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    const MomentumFrame& then = scene->frames[i - lag];
    const Eigen::Vector3d error = told.p_WC_m - then.com_m;
    finite = finite && error.allFinite() && told.angular_momentum_kgm2ps.allFinite();
    forward.Add(error.x());
    lateral.Add(error.y());
    vertical.Add(error.z());
    if (i < start + minute) first_minute.Add(error.z());
    if (i + minute >= scene->frames.size()) last_minute.Add(error.z());
    nees += error.z() * error.z() / told.position_variance_m2.z();
    ++judged;
    const auto cop = PressureOf(now.loads, 100);
    if (cop.cop_valid) {
      cop_forward.Add(cop.p_WP_m.x() - now.com_m.x());
      cop_lateral.Add(cop.p_WP_m.y() - now.com_m.y());
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      momentum_error[k].Add(told.angular_momentum_kgm2ps(axis) - now.angular_momentum(axis));
      momentum_true[k].Add(now.angular_momentum(axis));
    }
    for (std::size_t f = 0; f < kFeet; ++f) {
      contacts.Add(f, now.feet[f].load_n > kContactN, told.feet[f].contact, step_s);
      if (contacts.true_since_s[f] > kSettledContactS)
        place.Add((told.feet[f].p_WF_m + rest[f] - now.feet[f].middle_m).head<2>().norm());
    }
  }
  ordered_json out;
  out["frames"] = judged;
  out["rate_hz"] = scene->rate_hz;
  out["mode"] = options.paper ? "paper" : "best";
  out["lag_ms"] = 1000 * static_cast<double>(lag) * step_s;
  out["mass_kg"] = pose.mass_kg;
  out["finite"] = finite;
  out["cop_outside_sensors_share"] = scene->outside_share;
  out["com_forward_rms_cm"] = forward.centimetres();
  out["com_lateral_rms_cm"] = lateral.centimetres();
  out["com_horizontal_rms_cm"] = std::hypot(forward.centimetres(), lateral.centimetres());
  out["com_vertical_rms_cm"] = vertical.centimetres();
  out["com_vertical_first_minute_rms_cm"] = first_minute.centimetres();
  out["com_vertical_last_minute_rms_cm"] = last_minute.centimetres();
  out["com_vertical_nees"] = nees / static_cast<double>(judged);
  out["cop_forward_rms_cm"] = cop_forward.centimetres();
  out["cop_lateral_rms_cm"] = cop_lateral.centimetres();
  out["foot_position_rms_cm"] = place.centimetres();
  out["contact_f1"] = contacts.F1();
  out["landings"] = contacts.landings;
  out["landing_delay_ms"] = 1000 * contacts.mean_delay_s();
  out["landing_delay_worst_ms"] = 1000 * contacts.worst_delay_s;
  ordered_json& angular = out["angular_momentum_error_kgm2ps"];
  for (std::size_t k = 0; k < 3; ++k)
    angular.push_back({{"error", momentum_error[k].value()}, {"true", momentum_true[k].value()}});
  out["frame_us"] = 1e6 * busy_s / static_cast<double>(judged);
  if (offline) out["offline"] = OfflineJson(*scene, pose, start, start);
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
  command->add_option("--motion", options.motion, "Motion file: BVH, or AMC with --skeleton")
      ->required();
  command->add_option("--skeleton", options.skeleton, "Skeleton of an AMC motion, ASF file");
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
  command
      ->add_option("--cell-noise-kg", options.errors.noise_kg,
                   "Standard deviation of the noise of a sensor, kg")
      ->check(CLI::Range(0.0, 5.0));
  command
      ->add_option("--gain-error", options.errors.gain_spread,
                   "Standard deviation of the relative gain error of a sensor; 0.01 is one percent")
      ->check(CLI::Range(0.0, 0.2));
  command
      ->add_option("--slow-force-n", options.errors.slow_force_n,
                   "Slowly varying force error of a board, N")
      ->check(CLI::Range(0.0, 50.0));
  command
      ->add_option("--hysteresis-n", options.errors.hysteresis_n,
                   "Half width of a sensor's hysteresis, N")
      ->check(CLI::Range(0.0, 50.0));
  command->add_option("--seed", options.errors.seed, "Seed of the sensor errors");
  command->add_flag("--unlimited", options.unlimited, "Simulate boards of unlimited size");
  command->add_flag("--offline", flags->offline, "Run the offline smoothers as well");
  command->callback([flags, &shared] {
    flags->options.lag_s = flags->lag_ms / 1000;
    flags->options.paper = flags->mode == "paper";
    if (flags->options.paper && flags->lag_ms > 0) {
      shared.exit_code = cli::Report(UsageError("--lag-ms is the best mode's: paper has no lag"));
      return;
    }
    const auto out = Evaluate(flags->options, flags->offline);
    if (!out) {
      shared.exit_code = cli::Report(out.error());
      return;
    }
    PrintReport(*out, shared.json);
  });
}

}  // namespace footing::eval
