#include "daemon/offline/eval/momentum_command.h"

#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/cli/cli.h"
#include "common/virtual/options/sensor_options.h"
#include "daemon/offline/eval/momentum_score.h"
#include "daemon/offline/eval/offline.h"
#include "daemon/offline/eval/momentum_scene.h"
#include "daemon/offline/eval/print_report.h"
#include "daemon/simulation/momentum/best_estimator.h"
#include "daemon/simulation/momentum/paper_estimator.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;

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
        best_(BestConfigOf(options), subject, pose, step_s),
        paper_({}, subject, pose, step_s) {}

  const momentum::Estimate& Advance(const momentum::ContactLoads& loads) {
    const auto began = std::chrono::steady_clock::now();
    const momentum::Estimate& estimate =
        paper_mode_ ? paper_.Advance(loads, std::nullopt) : best_.Advance(loads);
    busy_s_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    return estimate;
  }
  double busy_s() const { return busy_s_; }

 private:
  const bool paper_mode_;
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

}  // namespace footing::eval
