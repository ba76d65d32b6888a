#include "daemon/offline/eval/arm/trial.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/body/kinematics.h"
#include "common/units/units.h"
#include "daemon/offline/eval/scores/pose_metrics.h"
#include "daemon/simulation/arms/arm_geometry.h"
#include "daemon/simulation/arms/arm_tracker.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;

/// One way to estimate an arm, against the truth.
class ArmScore {
 public:
  void Add(const arms::ArmGeometry& geometry, const arms::ArmDirections& estimate,
           const arms::ArmDirections& truth, const Eigen::Vector3d& hand_m) {
    shoulder_.Add(RadiansToDegrees(arms::ShoulderError(estimate, truth)));
    elbow_.Add(RadiansToDegrees(arms::ElbowError(estimate, truth)));
    cm_.push_back(100 * (geometry.Hand(estimate) - hand_m).norm());
    hand_.Add(cm_.back());
  }
  ordered_json Json() const {
    return {
        {"shoulder_error_deg", shoulder_.mean()},
        {"elbow_error_deg", elbow_.mean()},
        {"hand_position_rms_cm", hand_.rms()},
        {"hand_position_p95_cm", hand_.Quantile(0.95)},
        {"hand_position_rms_halves_cm", {Rms(0, cm_.size() / 2), Rms(cm_.size() / 2, cm_.size())}}};
  }

 private:
  double Rms(std::size_t from, std::size_t to) const {
    double squares = 0;
    for (std::size_t i = from; i < to; ++i) squares += cm_[i] * cm_[i];
    return to > from ? std::sqrt(squares / static_cast<double>(to - from)) : 0;
  }

  Spread shoulder_, elbow_, hand_;
  std::vector<double> cm_;  ///< Of hand_, in the order of time.
};

/// A network's own estimates of both arms from the T-pose on.
struct NetworkScore {
  const arm_network::ArmNetwork& network;
  std::array<arm_network::ArmPose, arms::kArms> poses = {};
  ArmScore score = {};
};

/// How far the estimated rotation of a hand since the T-pose is off, in all and of its up alone.
class TurnScore {
 public:
  void Add(const Eigen::Matrix3d& estimate, const Eigen::Matrix3d& truth) {
    const double cosine = ((estimate.transpose() * truth).trace() - 1) / 2;
    all_.Add(RadiansToDegrees(std::acos(std::clamp(cosine, -1.0, 1.0))));
    const double level = estimate.row(2).dot(truth.row(2));
    inclination_.Add(RadiansToDegrees(std::acos(std::clamp(level, -1.0, 1.0))));
  }
  double mean_deg() const { return all_.mean(); }
  double inclination_deg() const { return inclination_.mean(); }

 private:
  Spread all_, inclination_;
};

class ArmTrial {
 public:
  ArmTrial(const pose_run::ArmRun& run, const arms::ArmModel& model,
           const std::vector<arm_network::ArmNetwork>& networks)
      : run_(run),
        tracker_(model),
        geometry_{arms::ArmGeometry(run.body, 0), arms::ArmGeometry(run.body, 1)},
        at_(run.body.skeleton) {
    for (const arm_network::ArmNetwork& network : networks) networks_.push_back({network});
    mean_ = arms::Of(model.offset);
    body::ComputeKinematics(run.body.skeleton, run.frames.front().q, at_);
    for (std::size_t arm = 0; arm < arms::kArms; ++arm) rest_[arm] = HandAt(arm).transpose();
  }

  ordered_json Run() {
    const double step_s = 1 / run_.rate_hz;
    const auto first = static_cast<std::size_t>(std::lround(pose_run::kStandS * run_.rate_hz));
    for (std::size_t i = 0; i < run_.frames.size(); ++i) {
      const pose_run::ArmFrame& frame = run_.frames[i];
      for (std::size_t arm = 0; arm < arms::kArms; ++arm) {
        for (const arms::HandReading& reading : frame.readings[arm]) {
          tracker_.Add(arm, reading, run_.reading_s);
          newest_[arm] = reading;
          clipped_ += reading.clipped ? 1 : 0;
          ++readings_;
        }
      }
      if (i == run_.aligned) tracker_.Align();
      const auto& estimates = tracker_.Advance(step_s);
      if (i >= run_.aligned) AdvanceNetworks(step_s);
      if (i < first) continue;
      body::ComputeKinematics(run_.body.skeleton, frame.q, at_);
      for (std::size_t arm = 0; arm < arms::kArms; ++arm) Score(arm, estimates[arm]);
    }
    return Json(run_.frames.size() - first);
  }

 private:
  Eigen::Matrix3d HandAt(std::size_t arm) const {
    return at_.R_WJ[static_cast<std::size_t>(geometry_[arm].fist.joint)];
  }

  void AdvanceNetworks(double step_s) {
    for (std::size_t arm = 0; arm < arms::kArms; ++arm) {
      const auto input =
          arm_network::MakeInput(arm, newest_[arm], tracker_.hand(arm), tracker_.features());
      for (NetworkScore& one : networks_) {
        one.poses[arm] = one.network.Next(one.poses[arm], input, step_s);
      }
    }
  }

  void Score(std::size_t arm, const arms::ArmEstimate& estimate) {
    const arms::ArmGeometry& geometry = geometry_[arm];
    const arms::ArmDirections truth = geometry.Directions(at_);
    const Eigen::Vector3d hand_m =
        body::Place(geometry.fist, at_) - at_.p_WJ[static_cast<std::size_t>(geometry.shoulder)];
    estimate_.Add(geometry, estimate.directions, truth, hand_m);
    for (NetworkScore& one : networks_) {
      const auto own = arm_network::ToDirections(one.poses[arm], one.network.elbow_axis_U);
      one.score.Add(geometry, arm == 1 ? arms::Mirrored(own) : own, truth, hand_m);
    }
    still_.Add(geometry, arm == 1 ? arms::Mirrored(mean_) : mean_, truth, hand_m);
    turn_.Add(tracker_.hand(arm).turn_W, HandAt(arm) * rest_[arm]);
    const auto add = [this](const Eigen::Vector3d& error, const Eigen::Vector3d& sd) {
      nees_ += error.cwiseQuotient(sd).squaredNorm() / 9;
    };
    add(estimate.directions.upper - truth.upper, estimate.upper_sd);
    add(estimate.directions.hinge - truth.hinge, estimate.hinge_sd);
    add(estimate.directions.forearm - truth.forearm, estimate.forearm_sd);
    ++judged_;
    finite_ = finite_ && arms::Stacked(estimate.directions).allFinite();
  }

  ordered_json Json(std::size_t frames) const {
    ordered_json json = {{"frames", frames}, {"rate_hz", run_.rate_hz}};
    json.update(estimate_.Json());
    json["attitude_error_deg"] = turn_.mean_deg();
    json["inclination_error_deg"] = turn_.inclination_deg();
    json["clipped_share"] = static_cast<double>(clipped_) / static_cast<double>(readings_);
    json["nees"] = nees_ / static_cast<double>(judged_);
    json["finite"] = finite_;
    json["baselines"]["mean_arm"] = still_.Json();
    for (const NetworkScore& one : networks_) {
      json["networks"][arm_network::KindName(one.network.kind)] = one.score.Json();
    }
    return json;
  }

  const pose_run::ArmRun& run_;
  arms::ArmTracker tracker_;
  std::array<arms::ArmGeometry, arms::kArms> geometry_;
  std::array<Eigen::Matrix3d, arms::kArms> rest_;
  body::Kinematics at_;
  arms::ArmDirections mean_;
  std::vector<NetworkScore> networks_;
  std::array<arms::HandReading, arms::kArms> newest_{};
  ArmScore estimate_, still_;
  TurnScore turn_;
  std::size_t clipped_ = 0, readings_ = 0, judged_ = 0;
  double nees_ = 0;
  bool finite_ = true;
};

}  // namespace

ordered_json RunArmTrial(const pose_run::ArmRun& run, const arms::ArmModel& model,
                         const std::vector<arm_network::ArmNetwork>& networks) {
  return ArmTrial(run, model, networks).Run();
}

}  // namespace footing::eval
