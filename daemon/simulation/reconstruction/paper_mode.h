#pragma once

#include "daemon/simulation/pose/fibonacci.h"
#include "daemon/simulation/reconstruction/measurement.h"
#include "daemon/simulation/reconstruction/mode_state.h"

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

  ModeState state_;
  PaperEstimate estimate_;
  pose::FibonacciSearch solver_;
};

}  // namespace footing::reconstruction
