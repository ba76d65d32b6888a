#include "daemon/simulation/reconstruction/best_mode.h"

#include <algorithm>

#include "common/base/units.h"
#include "daemon/simulation/reconstruction/pose_targets.h"

namespace footing::reconstruction {
namespace {

// How far a head may be from where the T-pose has it, or, of a tracker that did not see the T-pose,
// from the middle of the head: one standard deviation along each axis.
constexpr double kSeatedSdM = 0.02, kUnseatedSdM = 0.05;

/// The less the feet bear, the less their loads show where C is ahead and aside: it may be where
/// hands and feet have it.
void DoubtUnloaded(double mass_kg, Measurement& then) {
  if (!then.posture_com_W_m) return;
  momentum::Estimate& momentum = then.momentum;
  const double load_n = momentum.feet[0].load_n + momentum.feet[1].load_n;
  const double unloaded = std::clamp(1 - load_n / (mass_kg * kStandardGravityMps2), 0.0, 1.0);
  const Eigen::Vector2d apart_m = (*then.posture_com_W_m - momentum.p_WC_m).head<2>();
  momentum.position_variance_m2.head<2>() += (unloaded * apart_m).cwiseAbs2();
}

}  // namespace

BestMode::BestMode(const SubjectModel& model, const Options& options)
    : state_(model, options),
      estimate_(model, options),
      solver_(model, options),
      report_(model, options.best) {}

void BestMode::Start(const momentum::TPose& pose) {
  state_.origin_m = BasisOrigin(*state_.model, pose);
  state_.pose.q = state_.model->t_pose;
  state_.pose.at = state_.model->t_pose_at;
  MoveToWorld(state_.origin_m, state_.pose);
  skeleton_.Start();
  lone_points_ = state_.model->joints;
  seat_.Start(lone_points_[kHeadJoint]);
  estimate_.Start(pose, state_.origin_m);
  measured_.Clear();
  truth_.Clear();
  solver_.Start(pose.mass_kg);
  rise_.Start();
  hold_.Start();
  report_.Start();
}

const JointPoints& BestMode::PointsOf(const JointInputs& joints) const {
  return IsSkeleton(joints) ? state_.model->joints : lone_points_;
}

void BestMode::Advance(const Inputs& inputs, const Truth& truth, Output& output) {
  const Measurement now = estimate_.Advance(Plausible(inputs), lone_points_);
  output.mass_kg = estimate_.mass_kg();
  ReportEstimate(now.momentum, state_.solver_resets, output);
  output.valid = output.valid && !now.momentum.stepped;
  output.posture_com_W_m = now.posture_com_W_m;
  Measurement then = Delayed(now);
  DoubtUnloaded(estimate_.mass_kg(), then);
  truth_.Add(truth);
  const Truth& true_then = truth_.Back(static_cast<std::size_t>(state_.options.lag_steps()));
  SetTargets(then, true_then, output);
  solver_.Solve(then, state_.targets, state_.origin_m, state_.pose);
  if (state_.options.clean_up) CleanUp(then, true_then);
  if (!state_.MovePoseToWorld(output)) {
    solver_.Reset();
    return;
  }
  seat_.See(UsableJoints(inputs.joints, state_.origin_m), state_.pose.at, state_.options.step_s());
  lone_points_[kHeadJoint] = seat_.point();
  skeleton_.Learn(state_.model->joints, then.joints, state_.pose.at, state_.options.step_s());
  Report(then, true_then, output);
}

Inputs BestMode::Plausible(const Inputs& inputs) const {
  Inputs plausible = skeleton_.Without(inputs);
  JointInput& head = plausible.joints[kHeadJoint];
  if (HeadSeat::IsLone(plausible.joints)) {
    head.valid = !seat_.Seeks();
    const double seat_m = seat_.found() ? kSeatedSdM : kUnseatedSdM;
    head.sd_m = (head.sd_m.cwiseAbs2().array() + seat_m * seat_m).sqrt();
  }
  GateJoints(PointsOf(plausible.joints), state_.pose.at, plausible.joints);
  return plausible;
}

Measurement BestMode::Delayed(const Measurement& now) {
  measured_.Add(now);
  Measurement then = measured_.Back(static_cast<std::size_t>(state_.options.lag_steps()));
  // The filters report places as they were, the rest as it is.
  then.momentum.p_WC_m = now.momentum.p_WC_m;
  then.momentum.position_variance_m2 = now.momentum.position_variance_m2;
  then.momentum.trusted = now.momentum.trusted;
  then.momentum.stepped = now.momentum.stepped;
  return then;
}

void BestMode::SetTargets(const Measurement& then, const Truth& truth, const Output& output) {
  Clear(state_.targets);
  AddHandTargets(*state_.model, then, state_.options.best, state_.targets);
  if (truth.feet) {
    AddFeetTargets(*state_.model, *truth.feet, state_.targets);
    ShowFeet(*state_.model, state_.targets, state_.shown_feet);
  } else {
    // Beside a skeleton's joints, whose pose is about the mean of all, the usual heights serve
    // better.
    const FootSpread& usual = state_.options.best.foot;
    const FootSpread risen = rise_.Advance(then.hands, usual);
    AddFeetTargets(*state_.model, then, then.skeleton() ? usual : risen, state_.targets);
    hold_.ShowFeet(*state_.model, state_.targets, then.momentum, output, state_.options.step_s(),
                   state_.shown_feet);
  }
  // After the feet, whose places are the first targets of their joints.
  AddJointTargets(PointsOf(then.joints), then.joints, state_.targets);
  AddBeltTargets(*state_.model, then.belt, state_.options.best, state_.targets);
  SetMomentumTargets(*state_.model, then, output.mass_kg, state_.options, state_.targets);
  OverrideMomentumTargets(truth, state_.options, state_.targets);
  state_.MoveTargets();
}

void BestMode::CleanUp(const Measurement& then, const Truth& truth) {
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    if (then.momentum.feet[f].contact || truth.feet)
      state_.legs.Solve(state_.shown_feet, f, state_.pose);
  }
}

void BestMode::Report(const Measurement& then, const Truth& truth, Output& output) {
  report_.Report(state_, then, solver_.prior(), solver_.solver(), output);
  if (!truth.feet) AddAloftSpread(*state_.model, then.momentum, state_.options.best, output);
}

}  // namespace footing::reconstruction
