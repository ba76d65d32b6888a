#include "daemon/simulation/reconstruction/insole_mode.h"

#include "daemon/simulation/reconstruction/pose_targets.h"

namespace footing::reconstruction {

InsoleMode::InsoleMode(const SubjectModel& model, const Options& options)
    : state_(model, options),
      estimate_(model, options),
      solver_(model.body, model.basis, BasisSolverOptions(options)),
      report_(model, options.best) {}

void InsoleMode::Start(const momentum::TPose& pose) {
  state_.origin_m = BasisOrigin(*state_.model, pose);
  estimate_.Start(pose, state_.origin_m);
  solver_.Reset();
  report_.Start();
}

void InsoleMode::Advance(const Inputs& inputs, const WalkPrior& prior, Output& output) {
  const Measurement now = estimate_.Advance(inputs, state_.model->joints);
  output.mass_kg = estimate_.mass_kg();
  ReportEstimate(now.momentum, state_.solver_resets, output);
  SetTargets(now, prior);
  solver_.Solve(state_.targets);
  state_.pose.q = solver_.q();
  state_.pose.at = solver_.at();
  if (state_.options.clean_up) state_.legs.SolveBoth(state_.shown_feet, state_.pose);
  if (!state_.MovePoseToWorld(output)) {
    solver_.Reset();
    return;
  }
  Report(now, output);
}

void InsoleMode::SetTargets(const Measurement& now, const WalkPrior& prior) {
  Clear(state_.targets);
  AddHandTargets(*state_.model, now, state_.options.best, state_.targets);
  AddFeetTargets(*state_.model, prior.feet, state_.targets);
  ShowFeet(*state_.model, state_.targets, state_.shown_feet);
  SetMomentumTargets(prior.com, state_.targets);
  state_.MoveTargets();
}

void InsoleMode::Report(const Measurement& now, Output& output) {
  const PriorOfPose prior{state_.model->basis, state_.options.best.prior_weight,
                          state_.model->basis.mean, solver_.q()};
  report_.Report(state_, now, prior, solver_, output);
}

}  // namespace footing::reconstruction
