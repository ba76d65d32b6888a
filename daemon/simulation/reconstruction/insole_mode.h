#pragma once

#include "daemon/simulation/pose/gauss_newton.h"
#include "daemon/simulation/reconstruction/measurement.h"
#include "daemon/simulation/reconstruction/mode_state.h"

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

  ModeState state_;
  BestEstimate estimate_;
  pose::GaussNewton solver_;
  SolutionReport report_;
};

}  // namespace footing::reconstruction
