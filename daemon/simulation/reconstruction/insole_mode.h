#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "daemon/simulation/pose/gauss_newton.h"
#include "daemon/simulation/reconstruction/clean_up.h"
#include "daemon/simulation/reconstruction/measurement.h"
#include "daemon/simulation/reconstruction/report.h"

namespace footing::reconstruction {

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

  const SubjectModel* model_;
  Options options_;
  Eigen::Vector3d origin_m_ = Eigen::Vector3d::Zero();  ///< Of the basis' poses, W.
  BestEstimate estimate_;
  pose::PoseTargets targets_;
  pose::GaussNewton solver_;
  pose::PoseTargets shown_feet_;
  LegCleanUp legs_;
  SolvedPose pose_;
  MeanMisfit misfit_;
  PoseSpread spread_;
  std::uint32_t solver_resets_ = 0;
};

}  // namespace footing::reconstruction
