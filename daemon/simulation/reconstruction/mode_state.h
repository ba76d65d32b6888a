#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "daemon/simulation/pose/gauss_newton.h"
#include "daemon/simulation/reconstruction/clean_up.h"
#include "daemon/simulation/reconstruction/measurement.h"
#include "daemon/simulation/reconstruction/options.h"
#include "daemon/simulation/reconstruction/report.h"
#include "daemon/simulation/reconstruction/subject_model.h"

namespace footing::reconstruction {

/// What every mode has: the targets of a frame and the pose that they lead to. A value; `model`
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
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();  ///< Of the basis' poses, W.
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
  SolutionReport(const SubjectModel& model, const BestConstants& best) : spread_(model, best) {}

  void Start();
  /// After MovePoseToWorld: the pose of the instant `then`, which `solver` solved with `prior`.
  void Report(const ModeState& state, const Measurement& then, const PriorOfPose& prior,
              pose::GaussNewton& solver, Output& output);

 private:
  MeanMisfit misfit_;
  std::uint32_t resets_ = 0;  ///< Of the filters, whose contradictions end with each.
  PoseSpread spread_;
};

}  // namespace footing::reconstruction
