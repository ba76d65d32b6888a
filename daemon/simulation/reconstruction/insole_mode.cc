#include "daemon/simulation/reconstruction/insole_mode.h"

#include "daemon/simulation/reconstruction/pose_targets.h"

namespace footing::reconstruction {

InsoleMode::InsoleMode(const SubjectModel& model, const Options& options)
    : model_(&model),
      options_(options),
      estimate_(model, options),
      solver_(model.body, model.basis, BasisSolverOptions(options)),
      legs_(model),
      pose_{model.t_pose, model.t_pose_at},
      spread_(model, options.best) {}

void InsoleMode::Start(const momentum::TPose& pose) {
  origin_m_ = BasisOrigin(*model_, pose);
  estimate_.Start(pose, origin_m_);
  solver_.Reset();
  misfit_.Start();
  spread_.Start();
}

void InsoleMode::Advance(const Inputs& inputs, const WalkPrior& prior, Output& output) {
  const Measurement now = estimate_.Advance(inputs);
  output.mass_kg = estimate_.mass_kg();
  ReportEstimate(now.momentum, solver_resets_, output);
  SetTargets(now, prior);
  solver_.Solve(targets_);
  pose_.q = solver_.q();
  pose_.at = solver_.at();
  if (options_.clean_up) legs_.SolveBoth(shown_feet_, pose_);
  if (!pose_.q.allFinite()) {
    solver_.Reset();
    output.valid = false;
    ++solver_resets_;
    return;
  }
  MoveToWorld(origin_m_, pose_);
  Report(now, output);
}

void InsoleMode::SetTargets(const Measurement& now, const WalkPrior& prior) {
  Clear(targets_);
  AddHandTargets(*model_, now, options_.best, targets_);
  AddFeetTargets(*model_, prior.feet, targets_);
  ShowFeet(*model_, targets_, shown_feet_);
  SetMomentumTargets(prior.com, targets_);
  MoveOrigin(origin_m_, targets_);
  MoveOrigin(origin_m_, shown_feet_);
}

void InsoleMode::Report(const Measurement& now, Output& output) {
  ReportPose(pose_.q, pose_.at, output);
  const PriorOfPose prior{model_->basis, options_.best.prior_weight, model_->basis.mean,
                          solver_.q()};
  misfit_.Report(MisfitOf(*model_, targets_, origin_m_, pose_.at, prior), options_.step_s(),
                 output);
  const double doubt = Doubt(output.misfit);
  spread_.Advance(solver_);
  spread_.Report(doubt, output);
  ReportCom(now.momentum, output);
  if (targets_.has_com) {
    ReportPoseHeight(*model_, pose_.at, spread_.com_height_sd_m(), doubt, output);
  }
}

}  // namespace footing::reconstruction
