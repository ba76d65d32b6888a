#include "daemon/offline/eval/pose/trial.h"

#include <algorithm>
#include <cmath>

#include "common/body/momentum.h"
#include "common/clock/clock.h"
#include "daemon/offline/eval/pose/breakdown.h"
#include "daemon/offline/eval/scores/contact_score.h"
#include "daemon/offline/eval/scores/pose_metrics.h"
#include "daemon/offline/eval/scores/roughness.h"
#include "daemon/offline/eval/scores/stance_frames.h"
#include "daemon/offline/timing/momentum_cost.h"

namespace footing::eval {
namespace {

using momentum::kFeet;
using nlohmann::ordered_json;

constexpr double kStraightDeg =
    25;  // An elbow that is bent by less hardly changes the arm's reach.

/// Slope of |error| over time, by least squares.
class Drift {
 public:
  void Add(double t_s, double error) {
    ++n_;
    t_ += t_s;
    e_ += error;
    tt_ += t_s * t_s;
    te_ += t_s * error;
  }
  double PerMinute() const {
    const double spread = n_ * tt_ - t_ * t_;
    return spread > 0 ? 60 * (n_ * te_ - t_ * e_) / spread : 0;
  }

 private:
  double n_ = 0, t_ = 0, e_ = 0, tt_ = 0, te_ = 0;
};

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

/// Everything that is evaluated beside the pose itself.
class Judge {
 public:
  Judge(const pose_run::PoseRun& run, std::size_t lag)
      : run_(run), lag_(lag), score_(run.body), breakdown_(run) {
    for (int side = 0; side < 2; ++side) {
      const auto f = static_cast<std::size_t>(side);
      ankle_[f] = body::Ankle(run.body, side).joint;
      toe_[f] = body::Toe(run.body, side).joint;
    }
    first_on_feet_ = static_cast<std::size_t>(
        std::lround((pose_run::kStandS + pose_run::kLeaveS) * run.rate_hz));
  }

  void Add(const reconstruction::Output& output, std::size_t i) {
    const pose_run::Frame& then = run_.frames[i - lag_];
    score_.Add(output.q, then.q);
    AddCom(output, then);
    AddFeet(output, i);
    AddRoughness(output, then);
    breakdown_.Add(output, score_, i - lag_);
    for (std::size_t k = 0; k < output.joint_sd_m.size(); ++k) {
      nees_ += score_.errors_m()[k].squaredNorm() / (3 * std::pow(output.joint_sd_m[k], 2));
      ++nees_count_;
    }
    invalid_ += output.valid ? 0 : 1;
    misfit_.Add(output.misfit);
    finite_ = finite_ && output.q.allFinite();
  }

  ordered_json Json() const;

 private:
  void AddCom(const reconstruction::Output& output, const pose_run::Frame& then) {
    const Eigen::Vector3d told = output.com_W_m - then.com_m;
    vertical_.Add(100 * told.z());
    horizontal_.Add(100 * told.head<2>().norm());
    forward_.Add(100 * told.x());
    lateral_.Add(100 * told.y());
    const double t_s = then.inputs.loads.time_s;
    vertical_drift_.Add(t_s, 100 * std::abs(told.z()));
    horizontal_drift_.Add(t_s, 100 * told.head<2>().norm());
    const Eigen::Vector3d com = body::CentreOfMass(run_.body, score_.at());
    pose_vertical_.Add(100 * (com.z() - then.com_m.z()));
    loads_vertical_.Add(100 * (output.momentum.p_WC_m.z() - then.com_m.z()));
    com_nees_ += told.z() * told.z() / output.com_variance_m2.z();
    ++com_count_;
    pose_horizontal_.Add(100 * (com - then.com_m).head<2>().norm());
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      angular_[static_cast<std::size_t>(axis)].Add(output.momentum.angular_momentum_kgm2ps(axis) -
                                                   then.angular_momentum(axis));
    }
  }

  void AddRoughness(const reconstruction::Output& output, const pose_run::Frame& then) {
    com_height_.Add(100 * output.com_W_m.z());
    true_com_height_.Add(100 * then.com_m.z());
    loads_com_height_.Add(100 * output.momentum.p_WC_m.z());
    for (int side = 0; side < 2; ++side) {
      const auto hand = static_cast<std::size_t>(side);
      const body::Landmarks& landmarks = run_.body.landmarks;
      const double bend_deg = ElbowBendDeg(landmarks, score_.truth(), side);
      const bool straight = bend_deg < kStraightDeg;
      elbow_[hand].Add(ElbowBendDeg(landmarks, score_.at(), side), straight);
      true_elbow_[hand].Add(bend_deg, straight);
    }
  }

  void AddFeet(const reconstruction::Output& output, std::size_t i) {
    const double step_s = 1 / run_.rate_hz;
    for (std::size_t f = 0; f < kFeet; ++f) {
      const bool told = output.momentum.feet[f].contact;
      contacts_.Add(f, run_.frames[i].feet[f].load_n > kContactN, told, step_s);
      const auto at = [&](const body::Kinematics& k, int joint) {
        return k.p_WJ[static_cast<std::size_t>(joint)];
      };
      const bool settled = i - lag_ >= first_on_feet_;
      AddSkate(run_.frames[i - lag_].inputs.loads.feet[f], f, settled, step_s);
      if (settled && contacts_.true_since_s[f] > kSettledContactS) {
        const Eigen::Vector3d error =
            0.5 * (at(score_.at(), ankle_[f]) + at(score_.at(), toe_[f]) -
                   at(score_.truth(), ankle_[f]) - at(score_.truth(), toe_[f]));
        place_.Add(100 * error.head<2>().norm());
      }
      const Eigen::Vector3d toe = at(score_.at(), toe_[f]), true_toe = at(score_.truth(), toe_[f]);
      if (told && told_before_[f]) {
        ball_speed_.Add(100 * (toe - toe_before_[f]).head<2>().norm() / step_s);
        true_ball_speed_.Add(100 * (true_toe - true_toe_before_[f]).head<2>().norm() / step_s);
      }
      toe_before_[f] = toe;
      true_toe_before_[f] = true_toe;
      told_before_[f] = told;
    }
  }

  /// The point of the sole where the true foot has its COP, as it moves with either foot.
  void AddSkate(const momentum::FootLoads& loads, std::size_t f, bool settled, double step_s) {
    const momentum::Pressure pressure = momentum::PressureOf(loads, kContactN);
    const auto at = [](const body::Kinematics& k, const body::Point& point) {
      const auto joint = static_cast<std::size_t>(point.joint);
      return body::Place(point, k.R_WJ[joint], k.p_WJ[joint]);
    };
    const reconstruction::FootGeometry& foot = geometry_[f];
    SolePoints told_now{at(score_.at(), foot.heel), at(score_.at(), foot.toe)};
    SolePoints true_now{at(score_.truth(), foot.heel), at(score_.truth(), foot.toe)};
    const Eigen::Vector2d along = (true_now[1] - true_now[0]).head<2>();
    const double from_heel = (pressure.p_WP_m - true_now[0]).head<2>().dot(along);
    const double share = pressure.cop_valid
                             ? std::clamp(from_heel / std::max(along.squaredNorm(), 1e-6), 0.0, 1.0)
                             : 0.5;
    const auto speed = [&](const SolePoints& now, const SolePoints& before) {
      const Eigen::Vector3d step_m =
          (1 - share) * (now[0] - before[0]) + share * (now[1] - before[1]);
      return 100 * step_m.head<2>().norm() / step_s;
    };
    if (const auto oldest = skate_[f].Advance(
            settled && pressure.cop_valid,
            {speed(told_now, sole_before_[f]), speed(true_now, true_sole_before_[f])}, step_s)) {
      told_skate_.Add((*oldest)[0]);
      true_skate_.Add((*oldest)[1]);
    }
    sole_before_[f] = told_now;
    true_sole_before_[f] = true_now;
  }

  using SolePoints = std::array<Eigen::Vector3d, 2>;  ///< Heel and ball.

  const pose_run::PoseRun& run_;
  std::size_t lag_;
  std::size_t first_on_feet_ = 0;  ///< Before, the way from the T-pose slides them.
  std::array<reconstruction::FootGeometry, kFeet> geometry_ =
      reconstruction::StandingFeet(run_.body);
  std::array<StanceFrames, kFeet> skate_;
  std::array<SolePoints, kFeet> sole_before_{}, true_sole_before_{};
  PoseScore score_;
  PoseBreakdown breakdown_;
  double com_nees_ = 0;
  std::size_t com_count_ = 0;
  Spread vertical_, horizontal_, forward_, lateral_, loads_vertical_, pose_vertical_,
      pose_horizontal_, place_, told_skate_, true_skate_, ball_speed_, true_ball_speed_;
  Roughness com_height_, true_com_height_, loads_com_height_;
  std::array<Roughness, 2> elbow_, true_elbow_;
  std::array<Spread, 3> angular_;
  Drift vertical_drift_, horizontal_drift_;
  ContactScore contacts_;
  std::array<int, kFeet> ankle_{}, toe_{};
  std::array<Eigen::Vector3d, kFeet> toe_before_{}, true_toe_before_{};
  std::array<bool, kFeet> told_before_{};
  double nees_ = 0, nees_count_ = 0;
  Spread misfit_;
  std::size_t invalid_ = 0;
  bool finite_ = true;
};

ordered_json Judge::Json() const {
  ordered_json json = score_.Json();
  json["com_vertical_rms_cm"] = vertical_.rms();
  json["com_horizontal_rms_cm"] = horizontal_.rms();
  json["com_forward_rms_cm"] = forward_.rms();
  json["com_lateral_rms_cm"] = lateral_.rms();
  json["com_forward_bias_cm"] = forward_.mean();
  json["com_forward_sd_cm"] =
      std::sqrt(std::max(0.0, std::pow(forward_.rms(), 2) - std::pow(forward_.mean(), 2)));
  json["com_vertical_drift_cm_per_min"] = vertical_drift_.PerMinute();
  json["com_horizontal_drift_cm_per_min"] = horizontal_drift_.PerMinute();
  json["loads_com_vertical_rms_cm"] = loads_vertical_.rms();
  json["com_vertical_nees"] = com_nees_ / static_cast<double>(std::max(com_count_, std::size_t{1}));
  json["pose_com_vertical_rms_cm"] = pose_vertical_.rms();
  json["pose_com_horizontal_rms_cm"] = pose_horizontal_.rms();
  for (const Spread& axis : angular_) json["angular_momentum_error_kgm2ps"].push_back(axis.rms());
  json["com_vertical_roughness_cm"] = com_height_.rms();
  json["com_vertical_roughness_true_cm"] = true_com_height_.rms();
  json["com_vertical_roughness_loads_cm"] = loads_com_height_.rms();
  json["straight_elbow_roughness_deg"] = {elbow_[0].rms(), elbow_[1].rms()};
  json["straight_elbow_roughness_true_deg"] = {true_elbow_[0].rms(), true_elbow_[1].rms()};
  json["foot_skate_cm_per_s"] = told_skate_.mean();
  json["foot_skate_true_cm_per_s"] = true_skate_.mean();
  json["ball_speed_in_contact_cm_per_s"] = ball_speed_.mean();
  json["ball_speed_in_contact_true_cm_per_s"] = true_ball_speed_.mean();
  json["foot_position_rms_cm"] = place_.rms();
  json["contact_f1"] = contacts_.F1();
  json["landings"] = contacts_.landings;
  json["landing_delay_ms"] = 1000 * contacts_.mean_delay_s();
  json["nees"] = nees_count_ > 0 ? nees_ / nees_count_ : 0;
  json.update(breakdown_.Json());
  json["misfit_p50"] = misfit_.Quantile(0.5);
  json["misfit_p95"] = misfit_.Quantile(0.95);
  json["invalid_frames"] = invalid_;
  json["finite"] = finite_;
  return json;
}

}  // namespace

Result<ordered_json> RunPoseTrial(const pose_run::PoseRun& run,
                                  const reconstruction::Models& models,
                                  const reconstruction::Options& options, const Oracle& oracle) {
  auto made = reconstruction::Reconstruction::Create(run.body, models, options);
  if (!made) return made.error();
  const std::size_t start = run.judged_from;
  Judge judge(run, static_cast<std::size_t>(std::lround(options.lag_s * options.rate_hz)));
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
    judge.Add(output, i);
  }
  ordered_json json = {{"frames", run.frames.size() - start},
                       {"rate_hz", run.rate_hz},
                       {"mass_kg", made->output().mass_kg},
                       {"lag_ms", 1000 * made->output().lag_s},
                       {"resets", made->output().resets}};
  json.update(judge.Json());
  const double unit_us = timing::MomentumCostUs(run.body, run.frames.front().q);
  json["solve_us_p50"] = solve_us.Quantile(0.5);
  json["solve_us_p99"] = solve_us.Quantile(0.99);
  json["kinematics_us"] = unit_us;
  json["solve_ratio_p50"] = solve_us.Quantile(0.5) / unit_us;
  json["solve_ratio_p99"] = solve_us.Quantile(0.99) / unit_us;
  return json;
}

}  // namespace footing::eval
