#pragma once

#include "daemon/simulation/momentum/horizontal_com.h"
#include "daemon/simulation/reconstruction/best_solver.h"
#include "daemon/simulation/reconstruction/clean_up.h"
#include "daemon/simulation/reconstruction/delay.h"
#include "daemon/simulation/reconstruction/head_seat.h"
#include "daemon/simulation/reconstruction/measurement.h"
#include "daemon/simulation/reconstruction/mode_state.h"
#include "daemon/simulation/reconstruction/skeleton.h"
#include "daemon/simulation/reconstruction/standing_rise.h"

namespace footing::reconstruction {

/// Boards and hands by what goes beyond the paper (docs/pose.md): filters with covariances, a
/// regressed mean, Gauss-Newton. A value; `model` must outlive it.
class BestMode {
 public:
  BestMode(const SubjectModel& model, const Options& options);

  /// The T-pose is complete.
  void Start(const momentum::TPose& pose);
  /// One frame after it.
  void Advance(const Inputs& inputs, const Truth& truth, Output& output);
  const Features& features() const { return solver_.features(); }
  const LikelyPosture& posture() const { return estimate_.posture(); }

 private:
  template <typename T>
  using Lag = Delay<T, momentum::HorizontalCom::kSlots>;

  /// What was measured at the instant that is reconstructed, with what is known of it now.
  Measurement Delayed(const Measurement& now);
  /// Without what the joints are off by in common, and without those that are implausible.
  Inputs Plausible(const Inputs& inputs) const;
  /// What these joints show.
  const JointPoints& PointsOf(const JointInputs& joints) const;
  void SetTargets(const Measurement& then, const Truth& truth, const Output& output);
  void CleanUp(const Measurement& then, const Truth& truth);
  void Report(const Measurement& then, const Truth& truth, Output& output);

  ModeState state_;
  SkeletonOffset skeleton_;
  HeadSeat seat_;
  JointPoints lone_points_;  ///< Of joints outside a skeleton.
  BestEstimate estimate_;
  Lag<Measurement> measured_;
  Lag<Truth> truth_;
  BestSolver solver_;
  StandingRise rise_;
  FootHold hold_;
  SolutionReport report_;
};

}  // namespace footing::reconstruction
