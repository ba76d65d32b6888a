#include "daemon/offline/eval/pose_trial.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "common/base/units.h"
#include "common/body/landmarks.h"
#include "common/runtime/clock.h"
#include "daemon/offline/analysis/angle_score.h"
#include "daemon/offline/analysis/pose_metrics.h"
#include "daemon/offline/compute/momentum_cost.h"
#include "daemon/offline/eval/momentum.h"
#include "daemon/offline/eval/pose_scores.h"
#include "daemon/simulation/reconstruction/subject_model.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;

/// An elbow that is bent by less hardly changes the arm's reach.
constexpr double kStraightDeg = 25;

reconstruction::Truth TruthOf(const pose_run::Frame& frame, const Oracle& oracle) {
  reconstruction::Truth truth;
  if (oracle.com) truth.com_W_m = frame.com_m;
  if (oracle.momentum) truth.angular_W = frame.angular_momentum;
  if (oracle.feet) {
    truth.feet =
        std::array{reconstruction::Truth::Foot{frame.feet[0].ankle_m, frame.feet[0].toe_m},
                   reconstruction::Truth::Foot{frame.feet[1].ankle_m, frame.feet[1].toe_m}};
  }
  return truth;
}

/// How smoothly the COM and the elbows of straight arms move.
class SmoothnessScore {
 public:
  void Add(const body::Landmarks& landmarks, const reconstruction::Output& output,
           const PoseScore& score, const pose_run::Frame& truth) {
    com_height_.Add(100 * output.com_W_m.z());
    true_com_height_.Add(100 * truth.com_m.z());
    loads_com_height_.Add(100 * output.momentum.p_WC_m.z());
    for (int side = 0; side < 2; ++side) {
      const auto arm = static_cast<std::size_t>(side);
      const double bend_deg = ElbowBendDeg(landmarks, score.truth(), side);
      const bool straight = bend_deg < kStraightDeg;
      elbow_[arm].Add(ElbowBendDeg(landmarks, score.at(), side), straight);
      true_elbow_[arm].Add(bend_deg, straight);
    }
  }

  void WriteTo(ordered_json& json) const {
    json["com_vertical_roughness_cm"] = com_height_.rms();
    json["com_vertical_roughness_true_cm"] = true_com_height_.rms();
    json["com_vertical_roughness_loads_cm"] = loads_com_height_.rms();
    json["straight_elbow_roughness_deg"] = {elbow_[0].rms(), elbow_[1].rms()};
    json["straight_elbow_roughness_true_deg"] = {true_elbow_[0].rms(), true_elbow_[1].rms()};
  }

 private:
  Roughness com_height_, true_com_height_, loads_com_height_;
  std::array<Roughness, 2> elbow_, true_elbow_;
};

/// The first frame of the clip, behind the T-pose that was put before it.
std::size_t ClipBegins(const pose_run::PoseRun& run) {
  const auto begin =
      static_cast<std::size_t>(std::lround((pose_run::kStandS + pose_run::kLeaveS) * run.rate_hz));
  return std::max(begin, run.judged_from);
}

/// All outputs of a trial against the truth.
class TrialScore {
 public:
  TrialScore(const pose_run::PoseRun& run, std::size_t lag)
      : run_(run),
        lag_(lag),
        pose_(run.body),
        angles_(run.body, run.rate_hz,
                static_cast<Eigen::Index>(ClipBegins(run) - run.judged_from + lag)),
        feet_(run, lag),
        breakdown_(run) {
    const JudgedJoints judged(run.body);
    groups_ = {
        {"legs", {judged.legs, {}}}, {"torso", {judged.torso, {}}}, {"arms", {judged.arms, {}}}};
  }

  /// The output that came with frame `i`.
  void Add(const reconstruction::Output& output, std::size_t i) {
    const pose_run::Frame& truth = run_.frames[i - lag_];
    pose_.Add(output.q, truth.q);
    angles_.Add(output, truth.q, output.valid);
    com_.Add(run_.body, output, pose_, truth);
    feet_.Add(output, pose_, i);
    smoothness_.Add(run_.body.landmarks, output, pose_, truth);
    breakdown_.Add(output, pose_, i - lag_);
    const auto off = [&](std::size_t k) {
      return pose_.errors_m()[k].squaredNorm() / (3 * std::pow(output.joint_sd_m[k], 2));
    };
    for (std::size_t k = 0; k < output.joint_sd_m.size(); ++k) nees_.Add(off(k));
    for (auto& [name, group] : groups_) {
      for (const int joint : group.joints) group.nees.Add(off(static_cast<std::size_t>(joint)));
    }
    AddValidity(output);
    misfit_.Add(output.misfit);
    finite_ = finite_ && output.q.allFinite();
  }

  Result<ordered_json> Json() const {
    ordered_json json = pose_.Json();
    if (const Result<void> written = angles_.WriteTo(json); !written) return written.error();
    com_.WriteTo(json);
    smoothness_.WriteTo(json);
    feet_.WriteTo(json);
    json["nees"] = nees_.mean();
    for (const auto& [name, group] : groups_) json["nees_of"][name] = group.nees.mean();
    json.update(breakdown_.Json());
    json["misfit_p50"] = misfit_.Quantile(0.5);
    json["misfit_p95"] = misfit_.Quantile(0.95);
    json["invalid_frames"] = invalid_;
    json["valid_fraction"] = 1 - static_cast<double>(invalid_) / static_cast<double>(frames_);
    json["not_valid_for"] = {{"no_loads", causes_.no_loads},
                             {"weight_elsewhere", causes_.weight_elsewhere},
                             {"height", causes_.height},
                             {"step", causes_.step},
                             {"misfit", causes_.misfit}};
    json["longest_invalid_s"] = static_cast<double>(longest_invalid_) / run_.rate_hz;
    json["finite"] = finite_;
    return json;
  }

 private:
  void AddValidity(const reconstruction::Output& output) {
    ++frames_;
    invalid_since_ = output.valid ? 0 : invalid_since_ + 1;
    longest_invalid_ = std::max(longest_invalid_, invalid_since_);
    if (output.valid) return;
    ++invalid_;
    ++(!output.momentum.valid          ? causes_.no_loads
       : !output.momentum.whole_weight ? causes_.weight_elsewhere
       : !output.momentum.trusted      ? causes_.height
       : output.momentum.stepped       ? causes_.step
                                       : causes_.misfit);
  }

  const pose_run::PoseRun& run_;
  const std::size_t lag_;
  PoseScore pose_;
  AngleScore angles_;
  ComScore com_;
  SmoothnessScore smoothness_;
  FootScore feet_;
  PoseBreakdown breakdown_;
  Spread nees_;  ///< Squared errors of all joints' positions over their stated variances.
  struct Group {
    std::vector<int> joints;
    Spread nees;
  };
  std::map<std::string, Group> groups_;
  Spread misfit_;
  std::size_t frames_ = 0, invalid_ = 0;
  std::size_t invalid_since_ = 0, longest_invalid_ = 0;  ///< Frames in a row.
  /// Frames that are not valid, by their cause.
  struct {
    std::size_t no_loads = 0, weight_elsewhere = 0, height = 0, step = 0, misfit = 0;
  } causes_;
  bool finite_ = true;
};

}  // namespace

Result<ordered_json> RunPoseTrial(const pose_run::PoseRun& run,
                                  const reconstruction::Models& models,
                                  const reconstruction::Options& options, const Oracle& oracle) {
  auto made = reconstruction::Reconstruction::Create(run.body, models, options);
  if (!made) return made.error();
  const std::size_t start = run.judged_from;
  TrialScore score(run, static_cast<std::size_t>(std::lround(options.lag_s * options.rate_hz)));
  Spread solve_us;
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    const reconstruction::Truth truth = TruthOf(run.frames[i], oracle);
    const std::int64_t begin_ns = clock::ThreadCpuNs();
    const reconstruction::Output& output = made->Advance(run.frames[i].inputs, truth);
    const auto spent_ns = static_cast<double>(clock::ThreadCpuNs() - begin_ns);
    if (i < start) continue;
    if (!output.calibrated) {
      return InvalidData("the T-pose never stood still on both boards: no calibration");
    }
    solve_us.Add(spent_ns / 1e3);
    score.Add(output, i);
  }
  ordered_json json = {{"frames", run.frames.size() - start},
                       {"rate_hz", run.rate_hz},
                       {"mass_kg", made->output().mass_kg},
                       {"lag_ms", 1000 * made->output().lag_s},
                       {"resets", made->output().resets}};
  const Result<ordered_json> figures = score.Json();
  if (!figures) return figures.error();
  json.update(*figures);
  const double unit_us = timing::MomentumCostUs(run.body, run.frames.front().q);
  json["solve_us_p50"] = solve_us.Quantile(0.5);
  json["solve_us_p99"] = solve_us.Quantile(0.99);
  json["kinematics_us"] = unit_us;
  json["solve_ratio_p50"] = solve_us.Quantile(0.5) / unit_us;
  json["solve_ratio_p99"] = solve_us.Quantile(0.99) / unit_us;
  return json;
}

namespace {

using reconstruction::Mode;

constexpr std::array kReported{"mpjpe_cm",
                               "mpjpe_p95_cm",
                               "mpjpe_root_relative_cm",
                               "mpjpe_legs_cm",
                               "mpjpe_torso_cm",
                               "mpjpe_arms_cm",
                               "joint_angle_error_deg",
                               "com_vertical_rms_cm",
                               "com_horizontal_rms_cm",
                               "pose_com_vertical_rms_cm",
                               "pose_com_horizontal_rms_cm",
                               "foot_position_rms_cm",
                               "foot_skate_cm_per_s",
                               "solve_us_p50",
                               "finite"};

struct Ablation {
  const char* without;
  bool reconstruction::Options::*term;  ///< Null: nothing is left out of the solver.
};

constexpr std::array kAblations{
    Ablation{"nothing", nullptr},
    Ablation{"angular_momentum", &reconstruction::Options::use_angular_momentum},
    Ablation{"momentum", &reconstruction::Options::use_momentum},
    Ablation{"cleanup", &reconstruction::Options::clean_up},
    Ablation{"basis", &reconstruction::Options::use_basis},
    Ablation{"posture", &reconstruction::Options::use_posture}};

Result<ordered_json> Row(const pose_run::PoseRun& run, const reconstruction::Models& models,
                         const reconstruction::Options& options, const std::string& without) {
  const auto trial = RunPoseTrial(run, models, options, {});
  if (!trial) return trial.error();
  ordered_json row = {{"mode", options.mode == Mode::kBest ? "best" : "paper"},
                      {"without", without}};
  for (const char* name : kReported) {
    if (trial->contains(name)) row[name] = (*trial)[name];
  }
  return row;
}

}  // namespace

Result<ordered_json> ScoreAblations(const pose_run::PoseRun& run,
                                    const reconstruction::Models& models,
                                    const reconstruction::Options& options) {
  ordered_json rows = ordered_json::array();
  for (const Mode mode : {Mode::kBest, Mode::kPaper}) {
    reconstruction::Options of_mode = options;
    of_mode.mode = mode;
    if (mode == Mode::kPaper) of_mode.lag_s = 0;
    for (const Ablation& ablation : kAblations) {
      // The paper's estimators know of no posture.
      if (mode == Mode::kPaper && ablation.term == &reconstruction::Options::use_posture) continue;
      reconstruction::Options without = of_mode;
      if (ablation.term != nullptr) without.*ablation.term = false;
      auto row = Row(run, models, without, ablation.without);
      if (!row) return row.error();
      rows.push_back(std::move(*row));
    }
    if (mode == Mode::kPaper && models.horizontal) {
      reconstruction::Models cop = models;
      cop.horizontal.reset();
      auto row = Row(run, cop, of_mode, "horizontal_network");
      if (!row) return row.error();
      rows.push_back(std::move(*row));
    }
  }
  return rows;
}

namespace {

using body::Landmark;
using pose_run::LegScore;
using pose_run::LiftOffs;

ordered_json LegJson(const LegScore& score) {
  return {
      {"count", score.count()},       {"hip_cm", score.error_cm(0)}, {"knee_cm", score.error_cm(1)},
      {"foot_cm", score.error_cm(2)}, {"hip_sd_cm", score.sd_cm(0)}, {"knee_sd_cm", score.sd_cm(1)},
      {"foot_sd_cm", score.sd_cm(2)}, {"hip_nees", score.nees(0)},   {"knee_nees", score.nees(1)},
      {"foot_nees", score.nees(2)},   {"nees", score.nees()}};
}

}  // namespace

PoseBreakdown::PoseBreakdown(const pose_run::PoseRun& run)
    : run_(run), lift_offs_(1 / run.rate_hz), activities_(run.activities.names.size()) {
  constexpr std::array kLeft{Landmark::kLeftHip, Landmark::kLeftKnee, Landmark::kLeftAnkle};
  for (std::size_t k = 0; k < kLeft.size(); ++k) {
    legs_[0][k] = run.body.landmarks[kLeft[k]];
    legs_[1][k] = run.body.landmarks[body::Mirrored(kLeft[k])];
  }
}

void PoseBreakdown::Add(const reconstruction::Output& estimate, const PoseScore& score,
                        std::size_t i) {
  const pose_run::Frame& frame = run_.frames[i];
  for (std::size_t f = 0; f < legs_.size(); ++f) {
    pose_run::LegError leg;
    for (std::size_t k = 0; k < legs_[f].size(); ++k) {
      const auto joint = static_cast<std::size_t>(legs_[f][k]);
      leg.error_m[k] = score.errors_m()[joint];
      leg.sd_m[k] = estimate.joint_sd_m[joint];
    }
    lift_offs_.Add(f, frame.feet[f].load_n, frame.feet[f].ankle_m, leg);
  }
  if (i >= run_.activities.of_frame.size()) return;
  const int activity = run_.activities.of_frame[i];
  if (activity < 0) return;
  Activity& one = activities_[static_cast<std::size_t>(activity)];
  one.mpjpe_cm.Add(score.last_mpjpe_cm());
  one.com_vertical_cm.Add(100 * (estimate.com_W_m.z() - frame.com_m.z()));
}

ordered_json PoseBreakdown::Json() const {
  ordered_json json;
  json["lift_offs"] = lift_offs_.count();
  json["lift_off"] = ordered_json::array();
  for (std::size_t i = 0; i < LiftOffs::kAfterS.size(); ++i) {
    ordered_json row = {{"after_s", LiftOffs::kAfterS[i]}};
    row.update(LegJson(lift_offs_.after(i)));
    json["lift_off"].push_back(row);
  }
  json["aloft"] = LegJson(lift_offs_.aloft());
  json["kick"] = {{"faster_than_mps", LiftOffs::kKickMps}, {"kicks", lift_offs_.kicks()}};
  json["kick"].update(LegJson(lift_offs_.kick()));
  if (activities_.empty()) return json;
  json["by_activity"] = ordered_json::array();
  for (std::size_t k = 0; k < activities_.size(); ++k) {
    const Activity& one = activities_[k];
    if (one.mpjpe_cm.size() == 0) continue;
    json["by_activity"].push_back({{"activity", run_.activities.names[k]},
                                   {"frames", one.mpjpe_cm.size()},
                                   {"mpjpe_cm", one.mpjpe_cm.mean()},
                                   {"mpjpe_p95_cm", one.mpjpe_cm.Quantile(0.95)},
                                   {"com_vertical_rms_cm", one.com_vertical_cm.rms()}});
  }
  return json;
}

namespace {

// Boards without contact for longer than a flight lasts have nobody on them.
constexpr double kMostFlightS = 1;

/// The fields of a trial that measured and simulated forces are compared by.
constexpr const char* kCompared[] = {"mpjpe_cm",
                                     "mpjpe_p95_cm",
                                     "mpjpe_root_relative_cm",
                                     "com_vertical_rms_cm",
                                     "com_horizontal_rms_cm",
                                     "com_forward_rms_cm",
                                     "com_lateral_rms_cm",
                                     "com_forward_bias_cm",
                                     "com_forward_sd_cm",
                                     "foot_position_rms_cm",
                                     "contact_f1",
                                     "nees"};

constexpr const char* kOfCom[] = {"com_vertical_rms_cm", "loads_com_vertical_rms_cm",
                                  "com_forward_rms_cm",  "com_forward_bias_cm",
                                  "com_forward_sd_cm",   "com_lateral_rms_cm"};

ordered_json FeetJson(const pose_run::PlateUse& use) {
  return {{"plate", use.plate},
          {"left_s", use.loaded_s[0]},
          {"right_s", use.loaded_s[1]},
          {"beside_cm", 100 * use.beside_m}};
}

/// The fields that compare the COM with that of the plates' own force, and how far the markers' COM
/// is from it, in cm along x, y and z.
Result<ordered_json> ByForce(const pose_run::PlateRun& plates, const reconstruction::Models& models,
                             const reconstruction::Options& options, const Oracle& oracle) {
  pose_run::PoseRun run = plates.measured;
  Eigen::Vector3d square_m2 = Eigen::Vector3d::Zero(), sum_m = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < plates.com_by_force_m.cols(); ++i) {
    Eigen::Vector3d& com_m = run.frames[run.judged_from + static_cast<std::size_t>(i)].com_m;
    const Eigen::Vector3d off_m = com_m - plates.com_by_force_m.col(i);
    square_m2 += off_m.cwiseAbs2();
    sum_m += off_m;
    com_m = plates.com_by_force_m.col(i);
  }
  const auto trial = RunPoseTrial(run, models, options, oracle);
  if (!trial) return trial.error();
  ordered_json json;
  for (const char* field : kOfCom) json[field] = trial->at(field);
  const auto frames = static_cast<double>(plates.com_by_force_m.cols());
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    json["markers_rms_cm"].push_back(100 * std::sqrt(square_m2(axis) / frames));
    json["markers_bias_cm"].push_back(100 * sum_m(axis) / frames);
  }
  return json;
}

/// For how long the boards are empty at most, from a frame on.
double EmptyS(const pose_run::PoseRun& run, std::size_t from) {
  double longest_s = 0, empty_s = 0;
  for (std::size_t i = from; i < run.frames.size(); ++i) {
    const momentum::Pressure pressure = momentum::PressureOf(run.frames[i].inputs.loads, kContactN);
    empty_s = pressure.total_n < kContactN ? empty_s + 1 / run.rate_hz : 0;
    longest_s = std::max(longest_s, empty_s);
  }
  return longest_s;
}

/// The centre of mass by the offline smoothers, from the cells alone.
Result<ordered_json> Offline(const pose_run::PoseRun& run) {
  MomentumScene scene;
  scene.rate_hz = run.rate_hz;
  scene.subject = reconstruction::SubjectOf(run.body);
  momentum::TPoseCalibration calibration;
  std::size_t start = 0;
  for (const pose_run::Frame& frame : run.frames) {
    scene.frames.push_back({frame.inputs.loads, frame.com_m, frame.angular_momentum, {}});
    if (!calibration.complete()) {
      calibration.Advance(frame.inputs.loads, 1 / run.rate_hz);
      ++start;
    }
  }
  if (!calibration.complete() || start > run.judged_from) {
    return InvalidData("the T-pose never stood still on both boards: no calibration");
  }
  if (EmptyS(run, start) > kMostFlightS) {
    return ordered_json{
        {"left_out",
         "nobody is on the boards for a time, and the smoothers cannot follow the body there"}};
  }
  return OfflineJson(scene, calibration.result(), start, run.judged_from);
}

}  // namespace

Result<ordered_json> ScorePlates(const pose_run::PlateRun& plates,
                                 const reconstruction::Models& models,
                                 const reconstruction::Options& options, const Oracle& oracle) {
  const auto simulated = RunPoseTrial(plates.simulated, models, options, oracle);
  if (!simulated) return simulated.error();
  const pose_run::PlateReport& report = plates.report;
  ordered_json json = {{"begin_s", report.begin_s},
                       {"end_s", report.end_s},
                       {"carried_share", report.supported_share},
                       {"mass_kg", report.mass_kg}};
  const double weight_n = plates.measured.body.mass_kg * kStandardGravityMps2;
  json["force_rms_percent"] = 100 * report.force_rms_n / weight_n;
  json["force_own_mass_rms_percent"] = 100 * report.force_own_mass_rms_n / weight_n;
  json["cop_forward_bias_cm"] = 100 * report.cop_bias_m.x();
  json["cop_forward_rms_cm"] = 100 * report.cop_rms_m.x();
  json["cop_lateral_rms_cm"] = 100 * report.cop_rms_m.y();
  json["of_feet"] = ordered_json::array();
  for (const pose_run::PlateUse& use : report.plates) json["of_feet"].push_back(FeetJson(use));
  const auto offline = Offline(plates.measured);
  if (!offline) return offline.error();
  json["offline"] = *offline;
  if (plates.com_by_force_m.cols() > 0) {
    const auto by_force = ByForce(plates, models, options, oracle);
    if (!by_force) return by_force.error();
    json["by_force"] = *by_force;
  }
  json["warnings"] = report.warnings;
  for (const char* field : kCompared) json["simulated"][field] = simulated->at(field);
  return json;
}

}  // namespace footing::eval
