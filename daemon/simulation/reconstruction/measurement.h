#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "daemon/simulation/momentum/best_estimator.h"
#include "daemon/simulation/momentum/calibration.h"
#include "daemon/simulation/momentum/estimate.h"
#include "daemon/simulation/momentum/horizontal_network.h"
#include "daemon/simulation/momentum/paper_estimator.h"
#include "daemon/simulation/pose/gauss_newton.h"
#include "daemon/simulation/reconstruction/inputs.h"
#include "daemon/simulation/reconstruction/output.h"
#include "daemon/simulation/reconstruction/posture.h"
#include "daemon/simulation/reconstruction/subject_model.h"

/// The first two steps of every mode: the T-pose, and what is estimated from the loads.
namespace footing::reconstruction {

/// What is measured of one instant: hands and arms that can be used, and the momentum.
struct Measurement {
  std::array<HandInput, kHands> hands;
  std::array<arms::ArmEstimate, kHands> arms;
  momentum::Estimate momentum;
  JointInputs joints = {};
  arms::HandState belt = {};
  /// COM by hands and feet alone, W; only with both hands.
  std::optional<Eigen::Vector3d> posture_com_W_m = std::nullopt;

  bool both_hands() const { return hands[0].valid && hands[1].valid; }
  /// Enough joints of a skeleton are seen, or inferred, to show the pose.
  bool skeleton() const;
};

/// Hands, joints, arms and belt as they are, those that are not finite or far from `origin_m` as
/// not valid.
std::array<HandInput, kHands> UsableHands(const std::array<HandInput, kHands>& hands,
                                          const Eigen::Vector3d& origin_m);
JointInputs UsableJoints(const JointInputs& joints, const Eigen::Vector3d& origin_m);
std::array<arms::ArmEstimate, kHands> UsableArms(const std::array<arms::ArmEstimate, kHands>& arms);
arms::HandState UsableBelt(const arms::HandState& belt);

/// Before the first T-pose and after each request for a new one: stands in a T-pose, nothing valid.
void ReportTPose(const SubjectModel& model, const Options& options, Output& output);
/// One frame of the T-pose. True in the frame that completes it.
bool Calibrate(const Inputs& inputs, double step_s, momentum::TPoseCalibration& calibration,
               Output& output);

/// Momentum of best mode: the filters of the loads, with where hands and feet alone place the COM.
class BestEstimate {
 public:
  /// `model` must outlive it.
  BestEstimate(const SubjectModel& model, const Options& options);

  void Start(const momentum::TPose& pose, const Eigen::Vector3d& origin_m);
  /// `points`: what joints outside a skeleton show.
  Measurement Advance(const Inputs& inputs, const JointPoints& points);
  /// Weighed in the T-pose, corrected since.
  double mass_kg() const { return estimator_->mass_kg(); }
  /// Of the last frame with both hands.
  const LikelyPosture& posture() const { return likely_; }

 private:
  /// Takes in the COM of poses of hands and feet alone: they use no load, so their errors are their
  /// own.
  void SeePosture(const JointPoints& points, Measurement& now);
  /// What a tracked head and a belt add to hands and feet. Not for the pose about the mean of all:
  /// the lateral filter knows how that one errs by hands and feet.
  void AddExtraTargets(const Measurement& now, const JointPoints& points);

  const SubjectModel* model_;
  Options options_;
  Eigen::Vector3d origin_m_ = Eigen::Vector3d::Zero();
  std::optional<momentum::BestEstimator> estimator_;  ///< From Start on.
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
      : model_(&model), step_s_(options.step_s()) {}

  void Start(const momentum::TPose& pose, const Eigen::Vector3d& origin_m);
  Measurement Advance(const Inputs& inputs);

 private:
  const SubjectModel* model_;
  double step_s_;
  Eigen::Vector3d origin_m_ = Eigen::Vector3d::Zero();
  std::optional<momentum::PaperEstimator> estimator_;      ///< From Start on.
  std::optional<momentum::HorizontalNetwork> horizontal_;  ///< Where the model has networks.
};

}  // namespace footing::reconstruction
