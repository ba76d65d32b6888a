#include "daemon/offline/eval/pose_trial.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/runtime/clock.h"
#include "daemon/offline/eval/breakdown.h"
#include "daemon/offline/eval/com_score.h"
#include "daemon/offline/eval/foot_score.h"
#include "daemon/offline/analysis/angle_score.h"
#include "daemon/offline/analysis/pose_metrics.h"
#include "daemon/offline/analysis/roughness.h"
#include "daemon/offline/compute/momentum_cost.h"

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

/// All outputs of a trial against the truth.
class TrialScore {
 public:
  TrialScore(const pose_run::PoseRun& run, std::size_t lag)
      : run_(run),
        lag_(lag),
        pose_(run.body),
        angles_(run.body),
        feet_(run, lag),
        breakdown_(run) {}

  /// The output that came with frame `i`.
  void Add(const reconstruction::Output& output, std::size_t i) {
    const pose_run::Frame& truth = run_.frames[i - lag_];
    pose_.Add(output.q, truth.q);
    angles_.Add(output.q, truth.q, output.valid);
    com_.Add(run_.body, output, pose_, truth);
    feet_.Add(output, pose_, i);
    smoothness_.Add(run_.body.landmarks, output, pose_, truth);
    breakdown_.Add(output, pose_, i - lag_);
    for (std::size_t k = 0; k < output.joint_sd_m.size(); ++k) {
      nees_ += pose_.errors_m()[k].squaredNorm() / (3 * std::pow(output.joint_sd_m[k], 2));
      ++nees_count_;
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
    json["nees"] = nees_count_ > 0 ? nees_ / nees_count_ : 0;
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
  double nees_ = 0, nees_count_ = 0;  ///< Of joints' places, summed.
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

}  // namespace footing::eval
