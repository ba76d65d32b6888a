#include "daemon/offline/eval/fusion_trial.h"

#include <algorithm>

#include "common/body/kinematics.h"
#include "common/body/points.h"
#include "common/body/skeleton_points.h"
#include "daemon/offline/eval/figure7.h"
#include "daemon/offline/eval/fused_score.h"
#include "daemon/simulation/pose/gauss_newton.h"
#include "daemon/simulation/reconstruction/pose_targets.h"
#include "daemon/simulation/reconstruction/reconstruction.h"
#include "daemon/simulation/reconstruction/skeleton.h"
#include "daemon/simulation/reconstruction/subject_model.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;
using reconstruction::Reconstruction;
using virtual_sensors::KinectSkeleton;

/// The four ways over the same frames.
class FusionTrial {
 public:
  FusionTrial(const pose_run::PoseRun& run, const reconstruction::SubjectModel& model,
              const reconstruction::Options& options)
      : run_(run),
        model_(model),
        options_(options),
        alone_(model.body, model.basis, reconstruction::BasisSolverOptions(options)),
        at_(run.body.skeleton) {
    // The basis has the origin of its poses between the feet of the T-pose.
    for (const auto& foot : run.frames.front().feet)
      origin_m_.head<2>() += 0.25 * (foot.ankle_m + foot.toe_m).head<2>();
  }

  FusionReport Run(Reconstruction& boards, Reconstruction& fused) {
    for (std::size_t i = 0; i < run_.frames.size(); ++i) Step(i, boards, fused);
    const auto ratio = [](double over, double under) { return under > 0 ? over / under : 0; };
    const FusedScore &skeleton = scores_[0], &both = scores_[3];
    return {{{"frames", run_.frames.size() - std::min(run_.judged_from, run_.frames.size())},
             {"squat_frames", squats_},
             {"hidden_joints", hidden_},
             {"skeleton", skeleton.Json()},
             {"skeleton_solved", scores_[1].Json()},
             {"boards_and_hands", scores_[2].Json()},
             {"fused", both.Json()},
             {"hip_ratio", ratio(both.hip_cm(), skeleton.hip_cm())},
             {"knee_ratio", ratio(both.knee_cm(), skeleton.knee_cm())},
             {"hidden_ratio", ratio(both.hidden_cm(), skeleton.hidden_cm())}},
            figure_.Svg()};
  }

 private:
  void Step(std::size_t i, Reconstruction& boards, Reconstruction& fused) {
    const pose_run::Frame& frame = run_.frames[i];
    reconstruction::Inputs without = frame.inputs;
    without.joints = {};
    for (reconstruction::HandInput& hand : without.hands) hand.of_skeleton = false;
    boards.Advance(without);
    if (!fused.Advance(frame.inputs).calibrated) return;
    SolveAlone(frame.inputs);
    if (i >= run_.judged_from) Score(frame, boards.output(), fused.output());
  }

  /// The skeleton without boards.
  void SolveAlone(const reconstruction::Inputs& inputs) {
    reconstruction::Measurement seen;
    seen.hands = inputs.hands;
    reconstruction::Clear(targets_);
    reconstruction::AddHandTargets(model_, seen, options_.best, targets_);
    reconstruction::AddJointTargets(model_.joints, inputs.joints, targets_);
    reconstruction::MoveOrigin(origin_m_, targets_);
    alone_.Solve(targets_);
  }

  void Score(const pose_run::Frame& frame, const reconstruction::Output& boards,
             const reconstruction::Output& fused) {
    StickPlaces then, reported;
    std::array<bool, stream::kBodyJoints> hidden;
    for (std::size_t i = 0; i < frame.kinect.size(); ++i) {
      const virtual_sensors::KinectPoint& point = frame.kinect[i];
      const bool is_hand = i < KinectSkeleton::kHands;
      (is_hand ? then.hands[i] : then.joints[i - KinectSkeleton::kHands]) = point.true_W_m;
      (is_hand ? reported.hands[i] : reported.joints[i - KinectSkeleton::kHands]) = point.p_W_m;
      if (!is_hand) hidden[i - KinectSkeleton::kHands] = point.hidden;
    }
    body::ComputeKinematics(run_.body.skeleton, frame.q, at_);
    const StickPlaces truth = PlacesOf(at_, Eigen::Vector3d::Zero());
    const StickPlaces of_fused = PlacesOf(fused);
    const bool squats = frame.kinect_crouches;
    scores_[0].Add(then.joints, reported.joints, hidden, squats);
    scores_[1].Add(truth.joints, PlacesOf(alone_.at(), origin_m_).joints, hidden, squats);
    scores_[2].Add(truth.joints, PlacesOf(boards).joints, hidden, squats);
    scores_[3].Add(truth.joints, of_fused.joints, hidden, squats);
    const auto count = static_cast<int>(std::count(hidden.begin(), hidden.end(), true));
    squats_ += squats ? 1 : 0;
    hidden_ += static_cast<std::size_t>(count);
    Figure7::Moment moment{0, frame.inputs.loads.time_s, count, truth, reported, of_fused};
    if (squats) {
      moment.weight = -truth.joints[body::IndexOf(stream::BodyJoint::kTorso)].z();
      figure_.AddSquat(moment);
    } else if (count > 0) {
      moment.weight = count;
      figure_.AddOther(moment);
    }
  }

  StickPlaces PlacesOf(const reconstruction::Output& output) {
    body::ComputeKinematics(run_.body.skeleton, output.q, at_);
    return PlacesOf(at_, Eigen::Vector3d::Zero());
  }

  StickPlaces PlacesOf(const body::Kinematics& at, const Eigen::Vector3d& origin_m) const {
    StickPlaces places;
    for (std::size_t i = 0; i < places.joints.size(); ++i) {
      places.joints[i] = origin_m + body::Place(model_.joints[i], at);
    }
    for (std::size_t side = 0; side < places.hands.size(); ++side) {
      places.hands[side] = origin_m + body::Place(model_.fists[side], at);
    }
    return places;
  }

  const pose_run::PoseRun& run_;
  const reconstruction::SubjectModel& model_;
  reconstruction::Options options_;
  pose::GaussNewton alone_;
  pose::PoseTargets targets_;
  body::Kinematics at_;
  std::array<FusedScore, 4> scores_;
  Figure7 figure_;
  Eigen::Vector3d origin_m_ = Eigen::Vector3d::Zero();
  std::size_t squats_ = 0, hidden_ = 0;
};

}  // namespace

Result<FusionReport> RunFusionTrial(const pose_run::PoseRun& run,
                                    const reconstruction::Models& models,
                                    const reconstruction::Options& options) {
  const auto model = reconstruction::BestSubjectModel(run.body, models, options);
  if (!model) return model.error();
  auto boards = Reconstruction::Create(run.body, models, options);
  if (!boards) return boards.error();
  auto fused = *boards;
  return FusionTrial(run, *model, options).Run(*boards, fused);
}

}  // namespace footing::eval
