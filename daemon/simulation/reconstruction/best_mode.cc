#include "daemon/simulation/reconstruction/best_mode.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "daemon/simulation/reconstruction/pose_targets.h"

namespace footing::reconstruction {

BestSolver::BestSolver(const SubjectModel& model, const Options& options)
    : model_(&model),
      options_(options),
      plain_(model.body, model.basis, BasisSolverOptions(options)),
      features_(options.step_s(), model.root_height_m(), model.body.mass_kg),
      posture_(model, options.step_s()),
      likely_q_(model.t_pose) {
  hands_W_m_.fill(Eigen::Vector3d::Zero());
  if (!model.posture.empty()) {
    posed_.emplace(model.body, model.posture.rest, RegressedSolverOptions(options));
  }
  if (model.regression.empty()) return;
  regressed_.emplace(model.body, model.rest, RegressedSolverOptions(options));
  workspace_ = model.regression.MakeWorkspace();
}

void BestSolver::Start(double mass_kg) {
  Reset();
  first_ = true;
  source_ = Source::kMean;
  placed_by_arms_ = false;
  posture_.Start();
  features_ = Features(options_.step_s(), model_->root_height_m(), mass_kg);
  for (std::size_t side = 0; side < kHands; ++side) {
    const auto joint = static_cast<std::size_t>(model_->fists[side].joint);
    hands_W_m_[side] = model_->t_pose_at.p_WJ[joint];
  }
}

void BestSolver::Reset() {
  plain_.Reset();
  if (regressed_) regressed_->Reset();
  if (posed_) posed_->Reset();
}

BestSolver::Source BestSolver::Choose(const Measurement& then) const {
  if (then.skeleton()) return Source::kMean;
  const bool hands =
      (then.hands[0].valid || then.arms[0].valid) && (then.hands[1].valid || then.arms[1].valid);
  if (hands && regressed_ && (then.momentum.trusted || !posed_)) return Source::kRegression;
  return hands && posed_ ? Source::kPosture : Source::kMean;
}

pose::GaussNewton& BestSolver::Solver(Source source) {
  if (source == Source::kRegression) return *regressed_;
  return source == Source::kPosture ? *posed_ : plain_;
}

void BestSolver::PlaceHandsByArms(const Measurement& then, const pose::PoseTargets& targets,
                                  const Eigen::Vector3d& origin_m) {
  const bool plain_goes_on = placed_by_arms_ || source_ == Source::kMean;
  placed_by_arms_ = Choose(then) != Source::kMean && !then.both_hands();
  if (!placed_by_arms_) return;
  if (!plain_goes_on) plain_.ContinueFrom(solver().q());
  plain_.Solve(targets);
  for (std::size_t side = 0; side < kHands; ++side) {
    const body::Point& fist = model_->fists[side];
    const auto joint = static_cast<std::size_t>(fist.joint);
    hands_W_m_[side] =
        origin_m + body::Place(fist, plain_.at().R_WJ[joint], plain_.at().p_WJ[joint]);
  }
}

void BestSolver::SolveAboutRegression(const Measurement& then, const pose::PoseTargets& targets,
                                      const Eigen::Vector3d& origin_m) {
  model_->regression.Predict(features_.values(), workspace_, likely_q_);
  likely_q_.head<3>() =
      likely_q_.head<3>() * model_->root_height_m() + then.momentum.p_WC_m - origin_m;
  regressed_->Solve(targets, likely_q_);
}

void BestSolver::Solve(const Measurement& then, const pose::PoseTargets& targets,
                       const Eigen::Vector3d& origin_m, SolvedPose& pose) {
  PlaceHandsByArms(then, targets, origin_m);
  for (std::size_t side = 0; side < kHands; ++side) {
    if (then.hands[side].valid) hands_W_m_[side] = then.hands[side].p_W_m;
  }
  features_.Advance(hands_W_m_, then.momentum);
  if (posed_) posture_.Advance(hands_W_m_, then.momentum.feet);
  const Source source = Choose(then);
  if (source != source_ && !first_) Solver(source).ContinueFrom(solver().q());
  first_ = false;
  source_ = source;
  if (source == Source::kRegression) {
    SolveAboutRegression(then, targets, origin_m);
  } else if (source == Source::kPosture) {
    likely_q_ = posture_.Predict(origin_m);
    posed_->Solve(targets, likely_q_);
  } else {
    plain_.Solve(targets);
  }
  pose.q = solver().q();
  pose.at = solver().at();
}

PriorOfPose BestSolver::prior() const {
  const double weight = options_.best.regressed_prior_weight;
  if (source_ == Source::kRegression) return {model_->rest, weight, likely_q_, regressed_->q()};
  if (source_ == Source::kPosture) {
    return {model_->posture.rest, weight, likely_q_, posed_->q()};
  }
  return {model_->basis, options_.best.prior_weight, model_->basis.mean, plain_.q()};
}

void StandingRise::FollowHands(const std::array<HandInput, kHands>& hands) {
  const bool both = hands[0].valid && hands[1].valid;
  if (first_) {
    first_ = false;
    known_ = both;
    for (std::size_t side = 0; side < kHands; ++side) t_pose_W_m_[side] = hands[side].p_W_m;
  }
  if (!known_) {
    away_m_ = std::numeric_limits<double>::infinity();
    return;
  }
  if (!both) return;
  double sum_m = 0;
  for (std::size_t side = 0; side < kHands; ++side) {
    sum_m += (hands[side].p_W_m - t_pose_W_m_[side]).norm();
  }
  away_m_ = std::max(away_m_, sum_m / kHands);
}

FootSpread StandingRise::Advance(const std::array<HandInput, kHands>& hands,
                                 const FootSpread& usual) {
  FollowHands(hands);
  const double left = 1 - std::exp(-away_m_ / usual.leave_m);  // 0 in the T-pose, then 1.
  FootSpread spread = usual;
  spread.ankle_rise *= left;
  spread.toe_rise *= left;
  spread.ankle_up = std::hypot(usual.flat_up, left * usual.ankle_up);
  spread.toe_up = std::hypot(usual.flat_up, left * usual.toe_up);
  return spread;
}

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

/// A hand that has turned far from where the last pose has it counts less, the less the further, as
/// GateJoints has it: a pose that is wrong about an arm would be pulled into another wrong one.
BodyTurns WithFarHandsDoubted(const SubjectModel& model, const body::Kinematics& at,
                              BodyTurns turns) {
  constexpr double kNearRad = 0.3, kDoubt = 2;
  for (std::size_t side = 0; side < kHands; ++side) {
    arms::HandState& turn = TurnOfHand(turns, side);
    if (!turn.valid) continue;
    const auto joint = static_cast<std::size_t>(model.fists[side].joint);
    const Eigen::Matrix3d off =
        turn.turn_W * model.t_pose_at.R_WJ[joint] * at.R_WJ[joint].transpose();
    const double far_rad = kDoubt * std::max(0.0, Eigen::AngleAxisd(off).angle() - kNearRad);
    turn.heading_sd_rad = std::hypot(turn.heading_sd_rad, far_rad);
    turn.inclination_sd_rad = std::hypot(turn.inclination_sd_rad, far_rad);
  }
  return turns;
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
  AddTurnTargets(*state_.model, WithFarHandsDoubted(*state_.model, state_.pose.at, then.turns),
                 state_.options.best, state_.targets);
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
