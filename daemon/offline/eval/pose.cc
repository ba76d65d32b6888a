#include "daemon/offline/eval/pose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/json_text.h"
#include "common/base/low_pass.h"
#include "common/base/units.h"
#include "common/cli/cli.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/motion/standard_layout.h"
#include "daemon/offline/analysis/pose_metrics.h"
#include "daemon/offline/eval/gait_trial.h"
#include "daemon/offline/eval/pose_scene.h"
#include "daemon/offline/eval/pose_scores.h"
#include "daemon/offline/eval/pose_trial.h"
#include "daemon/simulation/momentum/paper_estimator.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;

void DescribeSensors(const PoseFlags& flags, const pose_run::PoseRun& run, ordered_json& json) {
  json["mode"] = flags.mode;
  json["hands"] = flags.hands;
  json["head"] = flags.head;
  const auto& segments = flags.scene.settings.segments;
  json["belt"] = std::find(segments.begin(), segments.end(), reconstruction::BodySite::kPelvis) !=
                 segments.end();
  json["worn"] = ordered_json::array();
  for (const auto site : segments) {
    if (IsHand(site)) continue;
    json["worn"].push_back(reconstruction::kBodySiteNames[static_cast<std::size_t>(site)]);
  }
  json["hand_attitudes"] = std::any_of(segments.begin(), segments.end(), reconstruction::IsHand);
  json["worn_heading"] = ordered_json::array();
  for (const pose_run::FoundHeading& one : run.headings) {
    ordered_json row{
        {"segment", reconstruction::kBodySiteNames[static_cast<std::size_t>(one.site)]},
        {"known", one.known}};
    if (one.known) {
      row["error_deg"] = RadiansToDegrees(one.error_rad);
      row["sd_deg"] = RadiansToDegrees(one.sd_rad);
    }
    json["worn_heading"].push_back(row);
  }
  json["boards"] = flags.boards;
  json["boards_limited"] = flags.scene.settings.limited;
  json["cop_outside_sensors_share"] = run.outside_share;
}

/// Arms with devices, as the mode estimates them.
Result<void> EstimateArms(const PoseFlags& flags, const reconstruction::Models& models,
                          pose_run::PoseRun& run) {
  const bool paper = flags.options.mode == reconstruction::Mode::kPaper;
  const bool can = paper ? models.paper_arm.has_value() : models.arm.has_value();
  if (flags.hands == "wiimote" && !can) {
    return UsageError(
        std::string("--hands wiimote: give a model of kind ") +
        (paper ? "arm_paper too (footing-train arm --kind paper)" : "arm too (footing-train arm)"));
  }
  if (flags.hands != "wiimote" && flags.hands != "straps") return {};
  arms::ArmTracker tracker(models.arm, models.paper_arm);
  tracker.UseNetwork(paper);
  pose_run::EstimateArms(std::move(tracker), run);
  return {};
}

Result<ordered_json> Evaluate(PoseFlags flags) {
  if (const auto translated = Translate(flags); !translated) return translated.error();
  if (flags.claims) {  // About the motion and equation (2): no models.
    const auto run = MakePoseScene(flags.scene);
    if (!run) return run.error();
    return ordered_json{{"claims", CheckClaims(*run)}};
  }
  const auto models = ReadPoseModels(flags.models, flags.scene.motion, flags.same_person);
  if (!models) return models.error();
  // A basis of the user's own may be of another layout.
  flags.scene.standard_layout = motion::IsStandardLayout(models->dofs);
  if (flags.boards == "insoles") {
    const auto walk = MakeInsoleScene(flags.scene);
    if (!walk) return walk.error();
    return ScoreInsoles(*walk, *models, flags.options);
  }
  std::optional<pose_run::PlateRun> plates;
  if (flags.boards == "forces") {
    auto made = MakePlateScene(flags.scene);
    if (!made) return made.error();
    plates = *std::move(made);
  }
  auto run = plates ? Result<pose_run::PoseRun>(plates->measured) : MakePoseScene(flags.scene);
  if (!run) return run.error();
  if (auto done = EstimateArms(flags, *models, *run); !done) return done.error();
  if (flags.ablations) {
    const auto rows = ScoreAblations(*run, *models, flags.options);
    if (!rows) return Error{rows.error().kind, flags.scene.motion + ": " + rows.error().message};
    return ordered_json{{"ablations", *rows}};
  }
  const Oracle oracle{Has(flags.oracle, "com"), Has(flags.oracle, "momentum"),
                      Has(flags.oracle, "feet")};
  auto json = RunPoseTrial(*run, *models, flags.options, oracle);
  if (!json) return Error{json.error().kind, flags.scene.motion + ": " + json.error().message};
  DescribeSensors(flags, *run, *json);
  if (plates) {
    const auto judged = ScorePlates(*plates, *models, flags.options, oracle);
    if (!judged) return judged.error();
    (*json)["plates"] = *judged;
  }
  if (!flags.figures.empty()) {
    const auto names = WriteFigures(*run, *models, flags.options, flags.figures);
    if (!names) return names.error();
    (*json)["figures"] = *names;
  }
  if (!flags.baselines) return json;
  const std::size_t judged_from = run->judged_from;
  const auto baselines =
      ScoreBaselines(pose_run::WithoutExtras(*std::move(run)), *models, flags.options, judged_from);
  if (!baselines) return baselines.error();
  (*json)["baselines"] = *baselines;
  return json;
}

/// One line; a table has one for each row.
void PrintField(const std::string& name, const ordered_json& value) {
  if (value.empty() || !value.is_array() || !value.front().is_object()) {
    std::cout << name << ": " << text::ToText(value) << "\n";
    return;
  }
  std::cout << name << ":\n";
  for (const ordered_json& row : value) std::cout << "  " << text::ToText(row) << "\n";
}

}  // namespace

void AddPoseCommand(CLI::App& app, Shared& shared) {
  auto* command = app.add_subcommand("pose",
                                     "Whole-body pose estimated from two boards and two hands "
                                     "under a motion, compared with the motion");
  const auto flags = std::make_shared<PoseFlags>();
  flags->scene.settings.errors.noise_kg = 0.05;
  AddPoseFlags(*command, *flags);
  command->footer(
      "Examples:\n"
      "  footing-eval pose --motion clip.bvh --json\n"
      "  footing-eval pose --motion clip.bvh --activities labels.csv --json\n"
      "  footing-eval pose --motion squats.trc --still static.trc --boards forces "
      "--forces squats_grf.mot --mass-kg 60");
  command->callback([flags, &shared] {
    const auto out = Evaluate(*flags);
    if (!out) {
      shared.exit_code = cli::Report(out.error());
      return;
    }
    if (out->contains("plates")) {
      for (const auto& warning : out->at("plates").at("warnings")) {
        std::cerr << "warning: " << flags->scene.forces << ": " << warning.get<std::string>()
                  << "\n";
      }
    }
    if (shared.json) {
      std::cout << text::ToText(*out) << "\n";
    } else {
      for (const auto& [name, value] : out->items()) PrintField(name, value);
    }
  });
}

Result<ordered_json> ScoreInsoles(const pose_run::InsoleRun& run,
                                  const reconstruction::Models& models,
                                  const reconstruction::Options& options) {
  auto made = reconstruction::InsoleWalk::Create(run.body, models, options);
  if (!made) return made.error();
  const auto start = static_cast<std::size_t>(pose_run::kStandS * run.rate_hz);
  constexpr double kContactN = 40;
  PoseScore score(run.body), still(run.body);
  Spread root_cm;
  double both = 0, one = 0, walked_m = 0;
  bool finite = true;
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    const pose_run::InsoleFrame& frame = run.frames[i];
    const reconstruction::Output& output = made->Advance(frame.inputs);
    if (i < start) continue;
    if (!output.calibrated) {
      return InvalidData("the T-pose never stood still on both insoles: no calibration");
    }
    finite = finite && output.q.allFinite();
    score.Add(output.q, frame.q);
    still.Add(models.basis.mean, frame.q);
    root_cm.Add(100 * (output.q - frame.q).head<2>().norm());
    walked_m += (frame.q - run.frames[i - 1].q).head<2>().norm();
    for (std::size_t f = 0; f < momentum::kFeet; ++f) {
      const bool truth = frame.load_n[f] > kContactN;
      both += truth && made->contact(f) ? 1 : 0;
      one += truth != made->contact(f) ? 1 : 0;
    }
  }
  ordered_json json = {{"frames", score.Json().value("frames", run.frames.size() - start)},
                       {"rate_hz", run.rate_hz},
                       {"boards", "insoles"},
                       {"walked_m", walked_m}};
  json.update(score.Json());
  json["root_p50_cm"] = root_cm.Quantile(0.5);
  json["root_p95_cm"] = root_cm.Quantile(0.95);
  json["contact_f1"] = both > 0 ? 2 * both / (2 * both + one) : 0;
  json["finite"] = finite;
  json["baselines"]["mean_pose"]["mpjpe_root_relative_cm"] = still.Json()["mpjpe_root_relative_cm"];
  return json;
}

namespace {

double Still(const pose_run::PoseRun& run, const Eigen::VectorXd& q, std::size_t start) {
  PoseScore score(run.body);
  for (std::size_t i = start; i < run.frames.size(); ++i) {
    score.Add(q, run.frames[i].q);
  }
  return score.mpjpe_cm();
}

/// All frames of a reconstruction with these options.
Result<ordered_json> Rebuilt(const pose_run::PoseRun& run, const reconstruction::Models& models,
                             const reconstruction::Options& options, std::size_t start) {
  auto made = reconstruction::Reconstruction::Create(run.body, models, options);
  if (!made) return made.error();
  PoseScore score(run.body);
  const auto lag = static_cast<std::size_t>(std::lround(options.lag_s * options.rate_hz));
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    const auto& output = made->Advance(run.frames[i].inputs);
    if (i >= start) score.Add(output.q, run.frames[i - lag].q);
  }
  return score.Json();
}

}  // namespace

Result<ordered_json> ScoreBaselines(const pose_run::PoseRun& run,
                                    const reconstruction::Models& models,
                                    const reconstruction::Options& options, std::size_t start) {
  ordered_json json;
  const Eigen::VectorXd& t_pose = run.frames.front().q;
  json["t_pose"]["mpjpe_cm"] = Still(run, t_pose, start);
  Eigen::VectorXd mean = models.basis.mean;
  if (models.root_height_m > 0) {
    const body::Body& body = run.body;
    mean.head<3>() *= body::TPose(body.skeleton, body.landmarks)(2) / models.root_height_m;
  }
  for (const auto& foot : run.frames.front().feet) {
    mean.head<2>() += 0.25 * (foot.ankle_m + foot.toe_m).head<2>();
  }
  json["mean_pose"]["mpjpe_cm"] = Still(run, mean, start);

  reconstruction::Options without = options;
  without.use_momentum = without.use_angular_momentum = false;
  without.use_posture = false;
  const auto bare = Rebuilt(run, models, without, start);
  if (!bare) return bare.error();
  json["hands_feet_ik"] = *bare;
  if (!models.posture.empty()) {
    without.use_posture = true;
    const auto learned = Rebuilt(run, models, without, start);
    if (!learned) return learned.error();
    json["hands_feet_learned"] = *learned;
  }
  return json;
}

namespace {

constexpr double kRunS = 0.05;
constexpr double kLeastSpeedMps = 0.05;
constexpr double kPoseCutoffHz = 6;
constexpr std::array kAccelerationsMps2{0.1, 0.2, 0.35, 0.5};
constexpr std::array kAfterS{1.0, 5.0, 10.0};
constexpr double kOutlierN = 50;
constexpr double kOutlierAtS = 2;  // After the evaluated part begins.

ordered_json ConstantVelocity(const pose_run::PoseRun& simulated, std::size_t start) {
  const auto count = static_cast<Eigen::Index>(simulated.frames.size() - start);
  Eigen::MatrixXd com(3, count);
  for (Eigen::Index i = 0; i < count; ++i)
    com.col(i) = simulated.frames[start + static_cast<std::size_t>(i)].com_m;
  const double rate = simulated.rate_hz;
  const Eigen::MatrixXd smooth = LowPass(com, rate, kPoseCutoffHz);
  const Eigen::MatrixXd velocity = virtual_sensors::Derivative(smooth, rate);
  const Eigen::MatrixXd acceleration = virtual_sensors::Derivative(velocity, rate);
  ordered_json out = {
      {"definition",
       "percent of frames in runs of more than 0.05 s with |v| > 0.05 m/s and |a| under the limit; "
       "COM of the motion, low-passed at 6 Hz"},
      {"seconds", static_cast<double>(count) / rate},
      {"paper_percent", 0.5}};
  for (const double limit : kAccelerationsMps2) {
    out["rows"].push_back(
        {{"acceleration_under_mps2", limit},
         {"vertical_percent", 100 * ConstantVelocityShare(velocity.row(2), acceleration.row(2),
                                                          rate, kLeastSpeedMps, limit, kRunS)},
         {"all_axes_percent", 100 * ConstantVelocityShare(velocity, acceleration, rate,
                                                          kLeastSpeedMps, limit, kRunS)}});
  }
  return out;
}

/// Heights by equation (2) of these loads.
std::vector<double> Heights(const std::vector<double>& loads_n, double mass_kg, double rate_hz,
                            bool decay, std::optional<std::size_t> outlier) {
  momentum::PaperConfig config;
  config.vertical.enabled = decay;
  momentum::PaperVertical vertical(config.vertical, config.load_filter, mass_kg, 0);
  std::vector<double> heights;
  for (std::size_t i = 0; i < loads_n.size(); ++i) {
    vertical.Advance(loads_n[i] + (outlier == i ? kOutlierN : 0), 1 / rate_hz);
    heights.push_back(vertical.height_m());
  }
  return heights;
}

ordered_json Outlier(const std::vector<double>& loads_n, const std::vector<double>& true_m,
                     double mass_kg, double rate_hz) {
  const auto at = static_cast<std::size_t>(kOutlierAtS * rate_hz);
  ordered_json rows = ordered_json::array();
  for (const bool decay : {true, false}) {
    const auto clean = Heights(loads_n, mass_kg, rate_hz, decay, std::nullopt);
    const auto hit = Heights(loads_n, mass_kg, rate_hz, decay, at);
    for (const double after_s : kAfterS) {
      const std::size_t then = at + static_cast<std::size_t>(after_s * rate_hz);
      if (then >= clean.size()) continue;
      rows.push_back({{"decay", decay},
                      {"after_s", after_s},
                      {"drift_cm", 100 * (hit[then] - clean[then])},
                      {"own_error_cm", 100 * (clean[then] - true_m[then] + true_m[0])}});
    }
  }
  return rows;
}

}  // namespace

double ConstantVelocityShare(const Eigen::MatrixXd& velocity, const Eigen::MatrixXd& acceleration,
                             double rate_hz, double least_speed, double most_acceleration,
                             double least_run_s) {
  Eigen::Index counted = 0, run = 0;
  const auto close = [&] {
    if (static_cast<double>(run) / rate_hz > least_run_s) counted += run;
    run = 0;
  };
  for (Eigen::Index i = 0; i < velocity.cols(); ++i) {
    const bool constant =
        velocity.col(i).norm() > least_speed && acceleration.col(i).norm() < most_acceleration;
    if (constant) {
      ++run;
    } else {
      close();
    }
  }
  close();
  return velocity.cols() > 0 ? static_cast<double>(counted) / static_cast<double>(velocity.cols())
                             : 0;
}

ordered_json CheckClaims(const pose_run::PoseRun& simulated) {
  const auto start = static_cast<std::size_t>(pose_run::kStandS * simulated.rate_hz);
  std::vector<double> loads_n, true_m;
  double weight_n = 0;
  for (std::size_t i = 0; i < simulated.frames.size(); ++i) {
    const auto& frame = simulated.frames[i];
    const double total_n = momentum::PressureOf(frame.inputs.loads, 1).total_n;
    if (i < start) weight_n += total_n / static_cast<double>(start);
    if (i < start) continue;
    loads_n.push_back(total_n);
    true_m.push_back(frame.com_m.z());
  }
  const double mass_kg = NewtonsToKilograms(weight_n);
  const std::vector<double> still_n(static_cast<std::size_t>(13 * simulated.rate_hz), weight_n);
  const std::vector<double> still_m(still_n.size(), 0);
  return {{"constant_velocity", ConstantVelocity(simulated, start)},
          {"outlier",
           {{"definition",
             "one frame of 50 N too much; difference of the height by equation (2) from the same "
             "run without it, and that run's own error"},
            {"standing", Outlier(still_n, still_m, mass_kg, simulated.rate_hz)},
            {"in_motion", Outlier(loads_n, true_m, mass_kg, simulated.rate_hz)}}}};
}

}  // namespace footing::eval
