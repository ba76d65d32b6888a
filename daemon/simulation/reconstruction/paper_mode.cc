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
    : state_(model, options),
      estimate_(model, options),
      solver_(model.body, model.basis, SearchOptions(options)) {}

void PaperMode::Start(const momentum::TPose& pose) {
  state_.origin_m = BasisOrigin(*state_.model, pose);
  estimate_.Start(pose, state_.origin_m);
  solver_.Reset();
}

void PaperMode::Advance(const Inputs& inputs, const Truth& truth, Output& output) {
  const Measurement now = estimate_.Advance(inputs);
  ReportEstimate(now.momentum, state_.solver_resets, output);
  SetTargets(now, truth, output.mass_kg);
  solver_.Solve(state_.targets);
  state_.pose.q = solver_.q();
  body::ComputeKinematics(state_.model->body.skeleton, state_.pose.q, state_.pose.at);
  if (state_.options.clean_up) state_.legs.SolveBoth(state_.shown_feet, state_.pose);
  if (!state_.MovePoseToWorld(output)) {
    solver_.Reset();
    return;
  }
  ReportPose(state_.pose.q, state_.pose.at, output);
  ReportCom(now.momentum, output);
}

void PaperMode::SetTargets(const Measurement& now, const Truth& truth, double mass_kg) {
  Clear(state_.targets);
  AddPaperHandTargets(*state_.model, now, state_.targets);
  if (truth.feet) {
    AddFeetTargets(*state_.model, *truth.feet, state_.targets);
  } else {
    AddPaperFeetTargets(*state_.model, now, state_.targets);
  }
  ShowFeet(*state_.model, state_.targets, state_.shown_feet);
  SetPaperMomentumTargets(*state_.model, now, mass_kg, state_.options, state_.targets);
  OverrideMomentumTargets(truth, state_.options, state_.targets);
  state_.MoveTargets();
}

}  // namespace footing::reconstruction
