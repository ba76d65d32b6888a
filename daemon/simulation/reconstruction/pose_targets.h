#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "daemon/simulation/momentum/best_estimator.h"
#include "daemon/simulation/momentum/calibration.h"
#include "daemon/simulation/momentum/contacts.h"
#include "daemon/simulation/momentum/estimate.h"
#include "daemon/simulation/momentum/horizontal_network.h"
#include "daemon/simulation/momentum/paper_estimator.h"
#include "daemon/simulation/pose/gauss_newton.h"
#include "daemon/simulation/pose/targets.h"
#include "daemon/simulation/reconstruction/report.h"
#include "daemon/simulation/reconstruction/subject_model.h"

/// The first three steps of every mode: the T-pose, what is estimated from the loads, and the
/// targets of a frame's pose. And two of the modes: insoles, and the paper's.
namespace footing::reconstruction {

/// Measurements of one instant: hands and arms that can be used, and the momentum.
struct Measurement {
  std::array<HandInput, kHands> hands;
  std::array<arms::ArmEstimate, kHands> arms;
  momentum::Estimate momentum;
  JointInputs joints = {};
  BodyTurns turns = {};
  /// COM by hands and feet alone, W; only with both hands.
  std::optional<Eigen::Vector3d> posture_com_W_m = std::nullopt;

  bool both_hands() const { return hands[0].valid && hands[1].valid; }
  /// Enough joints of a skeleton are seen, or inferred, to show the pose.
  bool skeleton() const;
};

/// Hands, joints, arms and worn sensors as they are, those that are not finite or far from
/// `origin_m` as not valid.
std::array<HandInput, kHands> UsableHands(const std::array<HandInput, kHands>& hands,
                                          const Eigen::Vector3d& origin_m);
JointInputs UsableJoints(const JointInputs& joints, const Eigen::Vector3d& origin_m);
std::array<arms::ArmEstimate, kHands> UsableArms(const std::array<arms::ArmEstimate, kHands>& arms);
BodyTurns UsableTurns(const BodyTurns& turns);
/// How a hand has turned, of side 0 (left) or 1.
arms::HandState& TurnOfHand(BodyTurns& turns, std::size_t side);

/// How each leg leans in the T-pose beyond the straight one of the model, W.
using Stance = std::array<Eigen::Matrix3d, momentum::kFeet>;
/// People stand as wide as they like, and their feet show how wide. Their COM is over their COP,
/// ahead of the ankles, so the legs lean forwards from there.
Stance StanceOf(const SubjectModel& model, const momentum::TPose& pose,
                const Eigen::Vector3d& origin_m);
/// Turns of thighs and shanks, from the straight T-pose instead of the one that was taken.
BodyTurns FromStance(BodyTurns turns, const Stance& stance);

/// Before the first T-pose and after each request for a new one: stands in a T-pose, nothing valid.
void ReportTPose(const SubjectModel& model, const Options& options, Output& output);
/// One frame of the T-pose. True in the frame that completes it.
bool Calibrate(const Inputs& inputs, double step_s, momentum::TPoseCalibration& calibration,
               Output& output);

/// Momentum of best mode: from loads to contacts, from these and the hands to where they alone
/// place the COM, and from both to the filters of the momentum. Nothing goes back.
class BestEstimate {
 public:
  /// `model` must outlive it.
  BestEstimate(const SubjectModel& model, const Options& options);

  void Start(const momentum::TPose& pose, const Eigen::Vector3d& origin_m);
  /// `points`: what joints outside a skeleton show.
  Measurement Advance(const Inputs& inputs, const JointPoints& points);
  /// Weighed in the T-pose, corrected since.
  double mass_kg() const { return estimator_->mass_kg(); }
  /// Posture of the last frame with both hands.
  const LikelyPosture& posture() const { return likely_; }

 private:
  using Feet = std::array<momentum::FootEstimate, momentum::kFeet>;

  /// The COM of poses of hands and feet alone: they use no load, so their errors are their own.
  momentum::PostureCom FindPosture(const Feet& feet, const JointPoints& points, Measurement& now);
  /// Adds the targets of a tracked head and of worn sensors to hands and feet. Not for the pose
  /// about the mean of all: the lateral filter knows how that one errs by hands and feet.
  void AddExtraTargets(const Measurement& now, const JointPoints& points);

  const SubjectModel* model_;
  Options options_;
  Eigen::Vector3d origin_m_ = Eigen::Vector3d::Zero();
  std::optional<momentum::ContactEstimator> contacts_;  ///< From Start on, as the next.
  std::optional<momentum::BestEstimator> estimator_;
  Stance stance_;
  pose::PoseTargets targets_;
  LikelyPosture likely_;
  pose::GaussNewton plain_;                   ///< About the mean of all poses.
  std::optional<pose::GaussNewton> learned_;  ///< About likely postures, where there are such.
};

/// Momentum as the paper estimates it.
class PaperEstimate {
 public:
  /// `model` must outlive it.
  PaperEstimate(const SubjectModel& model, const Options& options)
      : model_(&model), config_(options.paper.momentum), step_s_(options.step_s()) {}

  void Start(const momentum::TPose& pose, const Eigen::Vector3d& origin_m);
  Measurement Advance(const Inputs& inputs);

 private:
  const SubjectModel* model_;
  momentum::PaperConfig config_;
  double step_s_;
  Eigen::Vector3d origin_m_ = Eigen::Vector3d::Zero();
  std::optional<momentum::PaperEstimator> estimator_;      ///< From Start on.
  std::optional<momentum::HorizontalNetwork> horizontal_;  ///< Where the model has networks.
};

/// State of every mode: the targets of a frame and the pose that they lead to. A value; `model`
/// must outlive it.
struct ModeState {
  ModeState(const SubjectModel& subject_model, const Options& mode_options);

  /// From W to the origin of the basis' poses.
  void MoveTargets();
  /// The solution of this frame, moved to W. False when it is not finite: the output is not valid,
  /// and the solver is to be reset.
  bool MovePoseToWorld(Output& output);

  const SubjectModel* model;
  Options options;
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();  ///< Origin of the basis' poses, W.
  pose::PoseTargets targets;
  pose::PoseTargets shown_feet;
  LegCleanUp legs;
  SolvedPose pose;
  std::uint32_t solver_resets = 0;
};

/// How well a solution by Gauss-Newton fits its terms: its misfit and the deviations that follow. A
/// value.
class SolutionReport {
 public:
  SolutionReport(const SubjectModel& model, const BestConstants& best)
      : spread_(model, best), angles_(model) {}

  void Start();
  /// After MovePoseToWorld: the pose of the instant `then`, which `solver` solved with `prior`.
  void Report(const ModeState& state, const Measurement& then, const PriorOfPose& prior,
              pose::GaussNewton& solver, Output& output);

 private:
  MeanMisfit misfit_;
  std::uint32_t resets_ = 0;  ///< Resets of the filters, whose contradictions end with each.
  PoseSpread spread_;
  AngleSpread angles_;
};

/// Insoles and hands: best mode's steps, with feet and COM where the model of a walk has them in
/// place of their estimates, about the mean of all poses. A value; `model` must outlive it.
class InsoleMode {
 public:
  InsoleMode(const SubjectModel& model, const Options& options);

  /// The T-pose is complete.
  void Start(const momentum::TPose& pose);
  /// One frame after it.
  void Advance(const Inputs& inputs, const WalkPrior& prior, Output& output);

 private:
  void SetTargets(const Measurement& now, const WalkPrior& prior);
  void Report(const Measurement& now, Output& output);

  ModeState state_;
  BestEstimate estimate_;
  pose::GaussNewton solver_;
  SolutionReport report_;
};

/// Boards and hands as in the paper (section 6): its estimators, one sweep of Fibonacci searches,
/// the clean-up of both legs. A value; `model` must outlive it.
class PaperMode {
 public:
  PaperMode(const SubjectModel& model, const Options& options);

  /// The T-pose is complete.
  void Start(const momentum::TPose& pose);
  /// One frame after it.
  void Advance(const Inputs& inputs, const Truth& truth, Output& output);

 private:
  void SetTargets(const Measurement& now, const Truth& truth, double mass_kg);

  ModeState state_;
  PaperEstimate estimate_;
  pose::FibonacciSearch solver_;
};

// The third step: what a frame's pose is solved for. Each function adds the terms of one source;
// a mode calls those that it has. Places are in W until MoveOrigin.

/// Fists where they are seen; of an arm whose hand is not seen, the arm-angle error of equation
/// (6): three of the shoulder, one of the elbow, as directions of the elbow from the shoulder, of a
/// point beside the upper arm, and of the fist from the elbow. Deviations are those of the inputs.
void AddHandTargets(const SubjectModel& model, const Measurement& then, const BestConstants& best,
                    pose::PoseTargets& targets);
/// The same with the fixed deviations of paper mode.
void AddPaperHandTargets(const SubjectModel& model, const Measurement& then,
                         const PaperConstants& constants, pose::PoseTargets& targets);

/// How worn sensors show their segments turned, as the directions of each segment that are up and
/// forward now: the way up has the deviation of the inclination, the way forward in level
/// directions that of the heading.
void AddTurnTargets(const SubjectModel& model, const BodyTurns& turns, const BestConstants& best,
                    pose::PoseTargets& targets);

/// Both feet by their estimates, with the deviations of recorded feet, or with those of paper mode.
void AddFeetTargets(const SubjectModel& model, const Measurement& then, const FootSpread& spread,
                    pose::PoseTargets& targets);
void AddPaperFeetTargets(const SubjectModel& model, const Measurement& then,
                         const PaperConstants& constants, pose::PoseTargets& targets);
/// Both feet where a walk has them, or where they truly are.
void AddFeetTargets(const SubjectModel& model, const std::array<FootPrior, momentum::kFeet>& feet,
                    pose::PoseTargets& targets);
void AddFeetTargets(const SubjectModel& model, const std::array<Truth::Foot, momentum::kFeet>& feet,
                    pose::PoseTargets& targets);

/// COM and angular momentum by their estimates. `mass_kg`: as weighed, which the loads' angular
/// momentum is of; the solver's masses are the body's.
void SetMomentumTargets(const SubjectModel& model, const Measurement& then, double mass_kg,
                        const Options& options, pose::PoseTargets& targets);
void SetPaperMomentumTargets(const SubjectModel& model, const Measurement& then, double mass_kg,
                             const Options& options, pose::PoseTargets& targets);
/// The COM where a walk has it.
void SetMomentumTargets(const std::optional<WalkPrior::Com>& com, pose::PoseTargets& targets);
/// Puts the truth, where there is one, in place of the estimates.
void OverrideMomentumTargets(const Truth& truth, const Options& options,
                             pose::PoseTargets& targets);

/// Takes away all targets.
void Clear(pose::PoseTargets& targets);
/// From W to a frame whose origin is there in W.
void MoveOrigin(const Eigen::Vector3d& origin_m, pose::PoseTargets& targets);

/// Ankle and ball.
using FootPoints = std::array<pose::PointTarget, 2>;
/// Those of the targets, where both are.
std::optional<FootPoints> PointsOf(const FootGeometry& foot, const pose::PoseTargets& targets);

}  // namespace footing::reconstruction
