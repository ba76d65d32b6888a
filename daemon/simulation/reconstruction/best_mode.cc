#include "daemon/simulation/reconstruction/best_mode.h"

#include "daemon/simulation/reconstruction/pose_targets.h"

namespace footing::reconstruction {

BestMode::BestMode(const SubjectModel& model, const Options& options)
    : model_(&model),
      options_(options),
      estimate_(model, options),
      solver_(model, options),
      legs_(model),
      pose_{model.t_pose, model.t_pose_at},
      spread_(model, options.best) {}

void BestMode::Start(const momentum::TPose& pose) {
  origin_m_ = BasisOrigin(*model_, pose);
  estimate_.Start(pose, origin_m_);
  measured_.Clear();
  truth_.Clear();
  solver_.Start(pose.mass_kg);
  hold_.Start();
  misfit_.Start();
  spread_.Start();
}

void BestMode::Advance(const Inputs& inputs, const Truth& truth, Output& output) {
  const Measurement now = estimate_.Advance(inputs);
  output.mass_kg = estimate_.mass_kg();
  ReportEstimate(now.momentum, solver_resets_, output);
  const Measurement then = Delayed(now);
  truth_.Add(truth);
  const Truth& true_then = truth_.Back(static_cast<std::size_t>(options_.lag_steps()));
  SetTargets(then, true_then, output);
  solver_.Solve(then, targets_, origin_m_, pose_);
  if (options_.clean_up) CleanUp(then, true_then);
  if (!pose_.q.allFinite()) {
    solver_.Reset();
    output.valid = false;
    ++solver_resets_;
    return;
  }
  MoveToWorld(origin_m_, pose_);
  Report(then, true_then, output);
}

Measurement BestMode::Delayed(const Measurement& now) {
  measured_.Add(now);
  Measurement then = measured_.Back(static_cast<std::size_t>(options_.lag_steps()));
  // The filters report places as they were, the rest as it is.
  then.momentum.p_WC_m = now.momentum.p_WC_m;
  then.momentum.position_variance_m2 = now.momentum.position_variance_m2;
  return then;
}

void BestMode::SetTargets(const Measurement& then, const Truth& truth, const Output& output) {
  Clear(targets_);
  AddHandTargets(*model_, then, options_.best, targets_);
  if (truth.feet) {
    AddFeetTargets(*model_, *truth.feet, targets_);
    ShowFeet(*model_, targets_, shown_feet_);
  } else {
    AddFeetTargets(*model_, then, options_.best.foot, targets_);
    hold_.ShowFeet(*model_, targets_, then.momentum, output, options_.step_s(), shown_feet_);
  }
  SetMomentumTargets(*model_, then, output.mass_kg, options_, targets_);
  OverrideMomentumTargets(truth, options_, targets_);
  MoveOrigin(origin_m_, targets_);
  MoveOrigin(origin_m_, shown_feet_);
}

void BestMode::CleanUp(const Measurement& then, const Truth& truth) {
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    if (then.momentum.feet[f].contact || truth.feet) legs_.Solve(shown_feet_, f, pose_);
  }
}

void BestMode::Report(const Measurement& then, const Truth& truth, Output& output) {
  ReportPose(pose_.q, pose_.at, output);
  misfit_.Report(MisfitOf(*model_, targets_, origin_m_, pose_.at, solver_.prior()),
                 options_.step_s(), output);
  const double doubt = Doubt(output.misfit);
  spread_.Advance(solver_.solver());
  spread_.Report(doubt, output);
  if (!truth.feet) AddAloftSpread(*model_, then.momentum, options_.best, output);
  ReportCom(then.momentum, output);
  if (targets_.has_com) {
    ReportPoseHeight(*model_, pose_.at, spread_.com_height_sd_m(), doubt, output);
  }
}

}  // namespace footing::reconstruction
