#include "daemon/offline/eval/arm_trial.h"

#include <array>
#include <cmath>

#include "common/body/kinematics.h"
#include "daemon/offline/eval/arm_bound.h"
#include "daemon/offline/eval/arm_score.h"
#include "daemon/simulation/pose/arm_geometry.h"
#include "daemon/simulation/pose/arm_tracker.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;

/// Of the kinematic prediction alone: a left forearm bends forwards.
const Eigen::Vector3d kElbowAxis_U = -Eigen::Vector3d::UnitZ();

/// A network's own estimates of both arms from the T-pose on.
struct NetworkScore {
  const arm_network::ArmNetwork& network;
  std::array<arm_network::ArmPose, arms::kArms> poses = {};
  ArmScore score = {};
};

class ArmTrial {
 public:
  ArmTrial(const pose_run::ArmRun& run, const std::optional<arms::ArmModel>& model,
           const std::vector<arm_network::ArmNetwork>& networks,
           const std::optional<pose_run::Places>& observed)
      : run_(run),
        tracker_(model),
        geometry_{arms::ArmGeometry(run.body, 0), arms::ArmGeometry(run.body, 1)},
        at_(run.body.skeleton) {
    for (const arms::ArmGeometry& geometry : geometry_) {
      if (observed) bounds_.emplace_back(geometry, *observed, run.rate_hz);
    }
    for (const arm_network::ArmNetwork& network : networks) networks_.push_back({network});
    if (model) mean_ = arms::Of(model->offset);
    body::ComputeKinematics(run.body.skeleton, run.frames.front().q, at_);
    for (std::size_t arm = 0; arm < arms::kArms; ++arm) {
      for (std::size_t place = 0; place < arms::kPlaces; ++place)
        rest_[arm][place] = SegmentAt(arm, place).transpose();
    }
  }

  ordered_json Run() {
    const double step_s = 1 / run_.rate_hz;
    const auto first = static_cast<std::size_t>(std::lround(pose_run::kStandS * run_.rate_hz));
    for (std::size_t i = 0; i < run_.frames.size(); ++i) {
      const pose_run::ArmFrame& frame = run_.frames[i];
      pose_run::Feed(frame.readings, run_.reading_s, tracker_);
      Count(frame.readings);
      if (i == run_.aligned) tracker_.Align();
      const auto& estimates = tracker_.Advance(step_s);
      if (i >= run_.aligned && tracker_.aligned()) AdvanceNetworks(step_s);
      if (i < first) continue;
      body::ComputeKinematics(run_.body.skeleton, frame.q, at_);
      for (std::size_t arm = 0; arm < arms::kArms; ++arm) Score(arm, estimates[arm]);
    }
    return Json(run_.frames.size() - first);
  }

 private:
  /// What a device there is fixed to.
  Eigen::Matrix3d SegmentAt(std::size_t arm, std::size_t place) const {
    const arms::ArmGeometry& geometry = geometry_[arm];
    const std::array joints{geometry.fist.joint, geometry.shoulder, geometry.elbow};
    return at_.R_WJ[static_cast<std::size_t>(joints[place])];
  }

  void Count(const pose_run::ArmReadings& readings) {
    for (std::size_t arm = 0; arm < arms::kArms; ++arm) {
      for (const auto& of_place : readings[arm]) {
        for (const arms::HandReading& reading : of_place) clipped_ += reading.clipped ? 1 : 0;
        readings_ += of_place.size();
      }
      if (!readings[arm][0].empty()) newest_[arm] = readings[arm][0].back();
    }
  }

  void AdvanceNetworks(double step_s) {
    for (std::size_t arm = 0; arm < arms::kArms; ++arm) {
      const auto input =
          arm_network::MakeInput(arm, newest_[arm], tracker_.hand(arm), tracker_.features());
      kinematic_pose_[arm] = arm_network::Predicted(kinematic_pose_[arm], kElbowAxis_U,
                                                    input.angular_velocity_W_radps, step_s);
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
    const auto kinematic = arm_network::ToDirections(kinematic_pose_[arm], kElbowAxis_U);
    kinematic_.Add(geometry, arm == 1 ? arms::Mirrored(kinematic) : kinematic, truth, hand_m);
    still_.Add(geometry, arm == 1 ? arms::Mirrored(mean_) : mean_, truth, hand_m);
    ArmMoment moment{
        .turns_W = {}, .truth = truth, .error = Distance(geometry, estimate.directions, truth)};
    for (std::size_t place = 0; place < arms::kPlaces; ++place) {
      moment.turns_W[place] = SegmentAt(arm, place) * rest_[arm][place];
      const arms::HandState& state = tracker_.hand(arm, static_cast<arms::Place>(place));
      if (state.valid) turn_.Add(state.turn_W, moment.turns_W[place]);
    }
    if (!bounds_.empty()) bounds_[arm].Add(moment);
    nees_.Add(estimate, truth);
    finite_ = finite_ && arms::Stacked(estimate.directions).allFinite();
  }

  ordered_json Json(std::size_t frames) const {
    ordered_json json = {{"frames", frames}, {"rate_hz", run_.rate_hz}};
    json.update(estimate_.Json());
    json["attitude_error_deg"] = turn_.mean_deg();
    json["inclination_error_deg"] = turn_.inclination_deg();
    json["clipped_share"] = static_cast<double>(clipped_) / static_cast<double>(readings_);
    json["nees"] = nees_.mean();
    json["nees_quarters"] = nees_.Parts(4);
    json["finite"] = finite_;
    if (!bounds_.empty()) json["observability"] = ArmBound::Json(bounds_);
    json["baselines"]["mean_arm"] = still_.Json();
    if (tracker_.aligned()) json["baselines"]["kinematic"] = kinematic_.Json();
    for (const NetworkScore& one : networks_) {
      json["networks"][arm_network::KindName(one.network.kind)] = one.score.Json();
    }
    return json;
  }

  const pose_run::ArmRun& run_;
  arms::ArmTracker tracker_;
  std::array<arms::ArmGeometry, arms::kArms> geometry_;
  std::vector<ArmBound> bounds_;  ///< Of each arm, or none.
  std::array<std::array<Eigen::Matrix3d, arms::kPlaces>, arms::kArms> rest_;
  body::Kinematics at_;
  arms::ArmDirections mean_;
  std::vector<NetworkScore> networks_;
  std::array<arms::HandReading, arms::kArms> newest_{};
  std::array<arm_network::ArmPose, arms::kArms> kinematic_pose_ = {};
  ArmScore estimate_, still_, kinematic_;
  TurnScore turn_;
  NeesScore nees_;
  std::size_t clipped_ = 0, readings_ = 0;
  bool finite_ = true;
};

}  // namespace

ordered_json RunArmTrial(const pose_run::ArmRun& run, const std::optional<arms::ArmModel>& model,
                         const std::vector<arm_network::ArmNetwork>& networks,
                         const std::optional<pose_run::Places>& observed) {
  return ArmTrial(run, model, networks, observed).Run();
}

}  // namespace footing::eval
