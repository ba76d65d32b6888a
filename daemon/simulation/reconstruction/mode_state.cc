#include "daemon/simulation/reconstruction/mode_state.h"

#include "daemon/simulation/reconstruction/pose_targets.h"

namespace footing::reconstruction {

ModeState::ModeState(const SubjectModel& subject_model, const Options& mode_options)
    : model(&subject_model),
      options(mode_options),
      legs(subject_model),
      pose{subject_model.t_pose, subject_model.t_pose_at} {}

void ModeState::MoveTargets() {
  MoveOrigin(origin_m, targets);
  MoveOrigin(origin_m, shown_feet);
}

bool ModeState::MovePoseToWorld(Output& output) {
  if (!pose.q.allFinite()) {
    output.valid = false;
    ++solver_resets;
    return false;
  }
  MoveToWorld(origin_m, pose);
  return true;
}

void SolutionReport::Start() {
  misfit_.Start();
  resets_ = 0;
  spread_.Start();
}

void SolutionReport::Report(const ModeState& state, const Measurement& then,
                            const PriorOfPose& prior, pose::GaussNewton& solver, Output& output) {
  ReportPose(state.pose.q, state.pose.at, output);
  if (then.momentum.resets != resets_) misfit_.Start();
  resets_ = then.momentum.resets;
  misfit_.Report(MisfitOf(*state.model, state.targets, state.origin_m, state.pose.at, prior),
                 state.options.step_s(), output);
  const double doubt = Doubt(output.misfit, then.momentum.trusted && !then.momentum.stepped);
  spread_.Advance(solver);
  spread_.Report(doubt, output);
  ReportCom(then.momentum, output);
  if (state.targets.has_com) {
    ReportPoseHeight(*state.model, state.pose.at, spread_.com_height_sd_m(), doubt, output);
  }
}

}  // namespace footing::reconstruction
