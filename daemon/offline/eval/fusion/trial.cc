#include "daemon/offline/eval/fusion/trial.h"

#include "common/body/kinematics.h"
#include "daemon/offline/eval/fusion/seen_skeleton.h"
#include "daemon/offline/eval/scores/pose_metrics.h"
#include "daemon/simulation/pose/gauss_newton.h"
#include "daemon/simulation/reconstruction/pose_targets.h"
#include "daemon/simulation/reconstruction/reconstruction.h"
#include "daemon/simulation/reconstruction/subject_model.h"

namespace footing::eval {
namespace {

using body::Landmark;
using nlohmann::ordered_json;
using virtual_sensors::KinectErrors;

// A common offset of a Kinect changes over 5 s (KinectErrors::kOffsetChangesS).
constexpr double kOffsetLearnedS = 1;

/// Errors of hips and knees, cm.
class LegScore {
 public:
  explicit LegScore(const body::Body& body) : body_(body) {}

  template <typename PlaceOf>
  void Add(const body::Kinematics& truth, const PlaceOf& place_of) {
    for (const Landmark left : {Landmark::kLeftHip, Landmark::kLeftKnee}) {
      Spread& spread = left == Landmark::kLeftHip ? hips_ : knees_;
      for (const int side : {0, 1}) {
        const int joint = body_.landmarks[body::OfSide(left, side)];
        spread.Add(100 * (place_of(joint) - truth.p_WJ[static_cast<std::size_t>(joint)]).norm());
      }
    }
  }
  void Add(const body::Kinematics& truth, const body::Kinematics& at,
           const Eigen::Vector3d& origin_m) {
    Add(truth, [&](int joint) -> Eigen::Vector3d {
      return origin_m + at.p_WJ[static_cast<std::size_t>(joint)];
    });
  }
  double hip_cm() const { return hips_.mean(); }
  double knee_cm() const { return knees_.mean(); }
  ordered_json Json() const {
    return {{"hip_cm", hips_.mean()},
            {"hip_p95_cm", hips_.Quantile(0.95)},
            {"knee_cm", knees_.mean()},
            {"knee_p95_cm", knees_.Quantile(0.95)}};
  }

 private:
  const body::Body& body_;
  Spread hips_, knees_;
};

pose::GaussNewtonOptions SolverOptions(const reconstruction::Options& options,
                                       const FusionOptions& fusion) {
  reconstruction::Options weighted = options;
  weighted.best.prior_weight = fusion.prior_weight;
  weighted.best.smooth_weight = fusion.smooth_weight;
  return reconstruction::BasisSolverOptions(weighted);
}

/// The four ways over the same frames.
class FusionTrial {
 public:
  FusionTrial(const pose_run::PoseRun& run, const reconstruction::SubjectModel& model,
              const reconstruction::Options& options, const FusionOptions& fusion)
      : run_(run),
        model_(model),
        options_(options),
        fusion_(fusion),
        seen_(run.body, fusion.seed, options.step_s()),
        alone_(model.body, model.basis, SolverOptions(options, fusion)),
        fused_(model.body, model.basis, SolverOptions(options, fusion)),
        truth_(run.body.skeleton),
        at_(run.body.skeleton),
        scores_(4, LegScore(run.body)) {
    // The basis has the origin of its poses between the feet of the T-pose.
    for (const auto& foot : run.frames.front().feet)
      origin_m_.head<2>() += 0.25 * (foot.ankle_m + foot.toe_m).head<2>();
    body::ComputeKinematics(run.body.skeleton, run.frames.front().q, truth_);
    standing_m_ = PelvisHeight();
  }

  ordered_json Run(reconstruction::Reconstruction& engine) {
    for (std::size_t i = 0; i < run_.frames.size(); ++i) Step(i, engine);
    const double alone_hip = scores_[0].hip_cm(), alone_knee = scores_[0].knee_cm();
    return {{"frames", run_.frames.size() - run_.judged_from},
            {"squat_frames", squats_},
            {"skeleton", scores_[0].Json()},
            {"skeleton_solved", scores_[1].Json()},
            {"boards_and_hands", scores_[2].Json()},
            {"fused", scores_[3].Json()},
            {"hip_ratio", alone_hip > 0 ? scores_[3].hip_cm() / alone_hip : 0},
            {"knee_ratio", alone_knee > 0 ? scores_[3].knee_cm() / alone_knee : 0}};
  }

 private:
  double PelvisHeight() const {
    const auto hip = [this](Landmark one) {
      return truth_.p_WJ[static_cast<std::size_t>(run_.body.landmarks[one])].z();
    };
    return 0.5 * (hip(Landmark::kLeftHip) + hip(Landmark::kRightHip));
  }

  void Step(std::size_t i, reconstruction::Reconstruction& engine) {
    const pose_run::Frame& frame = run_.frames[i];
    body::ComputeKinematics(run_.body.skeleton, frame.q, truth_);
    const bool squats = PelvisHeight() < fusion_.squat_share * standing_m_;
    const auto& joints = seen_.Advance(truth_, squats);
    const auto& output = engine.Advance(frame.inputs);
    if (!output.calibrated) return;

    pose::PoseTargets targets;
    AddSkeletonTargets(joints, targets);
    reconstruction::MoveOrigin(origin_m_, targets);
    alone_.Solve(targets);

    reconstruction::Clear(targets);
    AddSkeletonTargets(WithoutOffset(joints), targets);
    reconstruction::Measurement boards;
    boards.momentum = output.momentum;
    reconstruction::AddFeetTargets(model_, boards, options_.best.foot, targets);
    reconstruction::SetMomentumTargets(model_, boards, output.mass_kg, options_, targets);
    reconstruction::MoveOrigin(origin_m_, targets);
    fused_.Solve(targets);
    LearnOffset(joints);

    if (i < run_.judged_from || !squats) return;
    ++squats_;
    scores_[0].Add(truth_, [&joints](int joint) -> Eigen::Vector3d {
      for (const SeenJoint& seen : joints)
        if (seen.joint == joint) return seen.p_W_m;
      return Eigen::Vector3d::Zero();
    });
    scores_[1].Add(truth_, alone_.at(), origin_m_);
    body::ComputeKinematics(run_.body.skeleton, output.q, at_);
    scores_[2].Add(truth_, at_, Eigen::Vector3d::Zero());
    scores_[3].Add(truth_, fused_.at(), origin_m_);
  }

  /// The joints less what all of them are off by, as far as it is known, and with what is left.
  std::vector<SeenJoint> WithoutOffset(const std::vector<SeenJoint>& joints) const {
    std::vector<SeenJoint> moved = joints;
    for (SeenJoint& seen : moved) seen.p_W_m -= offset_m_;
    return moved;
  }

  /// Boards and feet stand still in W; what the joints that are seen are off from the pose that
  /// also follows those is followed with the time in which it changes.
  void LearnOffset(const std::vector<SeenJoint>& joints) {
    Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();
    int count = 0;
    for (const SeenJoint& seen : joints) {
      if (seen.sd_m.x() > 1.01 * KinectErrors::SdM()) continue;
      const auto joint = static_cast<std::size_t>(seen.joint);
      mean_m += seen.p_W_m - origin_m_ - fused_.at().p_WJ[joint];
      ++count;
    }
    if (count == 0) return;
    const double share = options_.step_s() / kOffsetLearnedS;
    offset_m_ += share * (mean_m / count - offset_m_);
  }

  const pose_run::PoseRun& run_;
  const reconstruction::SubjectModel& model_;
  reconstruction::Options options_;
  FusionOptions fusion_;
  SeenSkeleton seen_;
  pose::GaussNewton alone_, fused_;
  body::Kinematics truth_, at_;
  std::vector<LegScore> scores_;
  Eigen::Vector3d origin_m_ = Eigen::Vector3d::Zero(), offset_m_ = Eigen::Vector3d::Zero();
  double standing_m_ = 0;
  std::size_t squats_ = 0;
};

}  // namespace

Result<ordered_json> RunFusionTrial(const pose_run::PoseRun& run,
                                    const reconstruction::Models& models,
                                    const reconstruction::Options& options,
                                    const FusionOptions& fusion) {
  const auto model = reconstruction::BestSubjectModel(run.body, models, options);
  if (!model) return model.error();
  auto engine = reconstruction::Reconstruction::Create(run.body, models, options);
  if (!engine) return engine.error();
  return FusionTrial(run, *model, options, fusion).Run(*engine);
}

}  // namespace footing::eval
