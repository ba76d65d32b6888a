#include "daemon/simulation/reconstruction/paper_mode.h"

#include "common/body/kinematics.h"
#include "daemon/simulation/reconstruction/pose_targets.h"

namespace footing::reconstruction {
namespace {

pose::FibonacciOptions SearchOptions(const Options& options) {
  pose::FibonacciOptions search;
  search.frame_s = options.step_s();
  return search;
}

}  // namespace

PaperMode::PaperMode(const SubjectModel& model, const Options& options)
    : model_(&model),
      options_(options),
      estimate_(model, options),
      solver_(model.body, model.basis, SearchOptions(options)),
      legs_(model),
      pose_{model.t_pose, model.t_pose_at} {}

void PaperMode::Start(const momentum::TPose& pose) {
  origin_m_ = BasisOrigin(*model_, pose);
  estimate_.Start(pose, origin_m_);
  solver_.Reset();
}

void PaperMode::Advance(const Inputs& inputs, const Truth& truth, Output& output) {
  const Measurement now = estimate_.Advance(inputs);
  ReportEstimate(now.momentum, solver_resets_, output);
  SetTargets(now, truth, output.mass_kg);
  solver_.Solve(targets_);
  pose_.q = solver_.q();
  body::ComputeKinematics(model_->body.skeleton, pose_.q, pose_.at);
  if (options_.clean_up) legs_.SolveBoth(shown_feet_, pose_);
  if (!pose_.q.allFinite()) {
    solver_.Reset();
    output.valid = false;
    ++solver_resets_;
    return;
  }
  MoveToWorld(origin_m_, pose_);
  ReportPose(pose_.q, pose_.at, output);
  ReportCom(now.momentum, output);
}

void PaperMode::SetTargets(const Measurement& now, const Truth& truth, double mass_kg) {
  Clear(targets_);
  AddPaperHandTargets(*model_, now, targets_);
  if (truth.feet) {
    AddFeetTargets(*model_, *truth.feet, targets_);
  } else {
    AddPaperFeetTargets(*model_, now, targets_);
  }
  ShowFeet(*model_, targets_, shown_feet_);
  SetPaperMomentumTargets(*model_, now, mass_kg, options_, targets_);
  OverrideMomentumTargets(truth, options_, targets_);
  MoveOrigin(origin_m_, targets_);
  MoveOrigin(origin_m_, shown_feet_);
}

}  // namespace footing::reconstruction
