#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "daemon/simulation/pose/fibonacci.h"
#include "daemon/simulation/reconstruction/clean_up.h"
#include "daemon/simulation/reconstruction/measurement.h"
#include "daemon/simulation/reconstruction/report.h"

namespace footing::reconstruction {

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

  const SubjectModel* model_;
  Options options_;
  Eigen::Vector3d origin_m_ = Eigen::Vector3d::Zero();  ///< Of the basis' poses, W.
  PaperEstimate estimate_;
  pose::PoseTargets targets_;
  pose::FibonacciSearch solver_;
  pose::PoseTargets shown_feet_;
  LegCleanUp legs_;
  SolvedPose pose_;
  std::uint32_t solver_resets_ = 0;
};

}  // namespace footing::reconstruction
