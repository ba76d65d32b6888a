#include "daemon/simulation/reconstruction/pose_targets.h"

#include <cmath>
#include <cstddef>

#include "common/body/kinematics.h"
#include "daemon/simulation/reconstruction/report.h"
#include "daemon/simulation/reconstruction/subject_model.h"

namespace footing::reconstruction {
namespace {

constexpr double kMostHandM = 10;  // No part of a person is further from the cells.

bool IsUsable(const PointInput& point, const Eigen::Vector3d& origin_m) {
  return point.valid && point.p_W_m.allFinite() && point.sd_m.allFinite() &&
         point.covariance_m2.allFinite() && point.sd_m.minCoeff() > 0 &&
         (point.p_W_m - origin_m).norm() < kMostHandM;
}

bool UsableDirection(const Eigen::Vector3d& direction, const Eigen::Vector3d& sd) {
  return direction.allFinite() && sd.allFinite() && sd.minCoeff() > 0;
}

}  // namespace

bool Measurement::skeleton() const { return IsSkeleton(joints); }

std::array<HandInput, kHands> UsableHands(const std::array<HandInput, kHands>& hands,
                                          const Eigen::Vector3d& origin_m) {
  std::array<HandInput, kHands> usable = hands;
  for (HandInput& hand : usable) hand.valid = IsUsable(hand, origin_m);
  return usable;
}

JointInputs UsableJoints(const JointInputs& joints, const Eigen::Vector3d& origin_m) {
  JointInputs usable = joints;
  for (JointInput& joint : usable) joint.valid = IsUsable(joint, origin_m);
  return usable;
}

std::array<arms::ArmEstimate, kHands> UsableArms(
    const std::array<arms::ArmEstimate, kHands>& arms) {
  std::array<arms::ArmEstimate, kHands> usable = arms;
  for (arms::ArmEstimate& arm : usable) {
    arm.valid = arm.valid && UsableDirection(arm.directions.upper, arm.upper_sd) &&
                UsableDirection(arm.directions.hinge, arm.hinge_sd) &&
                UsableDirection(arm.directions.forearm, arm.forearm_sd);
  }
  return usable;
}

/// How each leg leans in the T-pose beyond the straight one of the model, W. People stand as wide
/// as they like, and their feet show how wide. Their COM is over their COP, ahead of the ankles, so
/// the legs lean forwards from there.
Stance StanceOf(const SubjectModel& model, const momentum::TPose& pose,
                const Eigen::Vector3d& origin_m) {
  const auto place = [&](int joint) -> const Eigen::Vector3d& {
    return model.t_pose_at.p_WJ[static_cast<std::size_t>(joint)];
  };
  std::array<Eigen::Vector3d, momentum::kFeet> straight_m, stands_m;
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    const FootGeometry& foot = model.feet[f];
    straight_m[f] = place(foot.ankle.joint);
    stands_m[f] = pose.p_WP_m[f] + foot.R_WF * foot.ankle_F_m;
  }
  const Eigen::Vector3d com_m =
      body::CentreOfMass(model.body, model.t_pose_at) - 0.5 * (straight_m[0] + straight_m[1]);
  const double ahead_m = (pose.cop_m - 0.5 * (stands_m[0] + stands_m[1])).x();
  const double forward_rad = std::atan2(ahead_m - com_m.x(), com_m.z());
  Stance stance;
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    const auto hip_landmark = body::OfSide(body::Landmark::kLeftHip, static_cast<int>(f));
    const Eigen::Vector3d hip_m = place(model.body.landmarks[hip_landmark]);
    const double down_m = hip_m.z() - straight_m[f].z();
    const double aside_rad = std::atan2((stands_m[f] - origin_m - hip_m).y(), down_m) -
                             std::atan2((straight_m[f] - hip_m).y(), down_m);
    stance[f] = (Eigen::AngleAxisd(forward_rad, Eigen::Vector3d::UnitY()) *
                 Eigen::AngleAxisd(aside_rad, Eigen::Vector3d::UnitX()))
                    .toRotationMatrix();
  }
  return stance;
}

BodyTurns UsableTurns(const BodyTurns& turns) {
  constexpr double kRounding = 1e-3;
  BodyTurns usable = turns;
  for (arms::HandState& one : usable) {
    const Eigen::Matrix3d square = one.turn_W.transpose() * one.turn_W;
    one.valid = one.valid && square.isIdentity(kRounding) && one.turn_W.determinant() > 0 &&
                std::isfinite(one.heading_sd_rad) && std::isfinite(one.inclination_sd_rad) &&
                one.heading_sd_rad >= 0 && one.inclination_sd_rad >= 0;
  }
  return usable;
}

arms::HandState& TurnOfHand(BodyTurns& turns, std::size_t side) {
  return turns[static_cast<std::size_t>(BodySite::kLeftHand) + side];
}

BodyTurns FromStance(BodyTurns turns, const Stance& stance) {
  for (const auto& [site, foot] : {std::pair{BodySite::kLeftThigh, 0},
                                   {BodySite::kRightThigh, 1},
                                   {BodySite::kLeftShank, 0},
                                   {BodySite::kRightShank, 1}}) {
    Eigen::Matrix3d& turn_W = turns[static_cast<std::size_t>(site)].turn_W;
    turn_W = turn_W * stance[static_cast<std::size_t>(foot)];
  }
  return turns;
}

void ReportTPose(const SubjectModel& model, const Options& options, Output& output) {
  const auto joints = static_cast<std::size_t>(model.body.skeleton.size());
  output.calibrated = false;
  output.calibration_progress = 0;
  output.valid = false;
  output.lag_s = options.lag_steps() * options.step_s();
  output.mass_kg = model.body.mass_kg;
  output.momentum = {};
  output.R_WJ.resize(joints);
  output.p_WJ_m.resize(joints);
  ReportPose(model.t_pose, model.t_pose_at, output);
  output.com_W_m = body::CentreOfMass(model.body, model.t_pose_at);
  output.com_variance_m2.setConstant(kUnknownSdM * kUnknownSdM);
  output.joint_sd_m.assign(joints, kUnknownSdM);
}

bool Calibrate(const Inputs& inputs, double step_s, momentum::TPoseCalibration& calibration,
               Output& output) {
  const bool complete = calibration.Advance(inputs.loads, step_s);
  output.calibration_progress = calibration.progress();
  output.calibration_restarts = calibration.restarts();
  if (!complete) return false;
  output.mass_kg = calibration.result().mass_kg;
  output.calibrated = true;
  return true;
}

BestEstimate::BestEstimate(const SubjectModel& model, const Options& options)
    : model_(&model),
      options_(options),
      likely_(model, options.step_s()),
      plain_(model.body, model.basis, PostureSolverOptions(options)) {
  if (!model.posture.empty()) {
    learned_.emplace(model.body, model.posture.rest, PostureSolverOptions(options));
  }
}

void BestEstimate::Start(const momentum::TPose& pose, const Eigen::Vector3d& origin_m) {
  momentum::BestConfig config;
  config.lag_s = options_.lag_steps() * options_.step_s();
  if (!model_->posture.empty()) config.height_posture_m = momentum::kLearnedPostureM;
  contacts_.emplace(model_->subject, pose, options_.step_s());
  estimator_.emplace(config, model_->subject, pose, options_.step_s());
  likely_.Start();
  plain_.Reset();
  if (learned_) learned_->Reset();
  origin_m_ = origin_m;
  stance_ = StanceOf(*model_, pose, origin_m);
}

Measurement BestEstimate::Advance(const Inputs& inputs, const JointPoints& points) {
  const momentum::ContactFrame& contacts = contacts_->Advance(inputs.loads);
  Measurement now{.hands = UsableHands(inputs.hands, origin_m_),
                  .arms = UsableArms(inputs.arms),
                  .momentum = {},
                  .joints = UsableJoints(inputs.joints, origin_m_),
                  .turns = FromStance(UsableTurns(inputs.turns), stance_)};
  // Where no tracker sees a hand, the arm's estimate has what its device measures.
  for (std::size_t side = 0; side < kHands; ++side) {
    if (!now.hands[side].valid) TurnOfHand(now.turns, side).valid = false;
  }
  std::optional<momentum::PostureCom> posture;
  if (options_.use_posture && now.both_hands()) posture = FindPosture(contacts.feet, points, now);
  now.momentum = estimator_->Advance(contacts, posture);
  return now;
}

momentum::PostureCom BestEstimate::FindPosture(const Feet& feet, const JointPoints& points,
                                               Measurement& now) {
  likely_.Advance({now.hands[0].p_W_m, now.hands[1].p_W_m}, feet);
  targets_ = {};
  AddHandTargets(*model_, now, options_.best, targets_);
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    AddFootTargets(model_->feet[f], feet[f], options_.best.foot, targets_);
  }
  MoveOrigin(origin_m_, targets_);
  plain_.Solve(targets_);
  const Eigen::Vector3d plain_m = body::CentreOfMass(model_->body, plain_.at());
  now.posture_com_W_m = origin_m_ + plain_m;
  if (learned_) {
    AddExtraTargets(now, points);
    learned_->Solve(targets_, likely_.Predict(origin_m_));
    now.posture_com_W_m = origin_m_ + body::CentreOfMass(model_->body, learned_->at());
  }
  return {origin_m_.y() + plain_m.y(), *now.posture_com_W_m};
}

void BestEstimate::AddExtraTargets(const Measurement& now, const JointPoints& points) {
  pose::PoseTargets extra;
  if (!now.skeleton()) AddJointTargets(points, now.joints, extra);
  BodyTurns turns = now.turns;
  // How hands turn shows the forearms; what the prior makes of it for the trunk misleads the
  // height.
  for (std::size_t side = 0; side < kHands; ++side) TurnOfHand(turns, side).valid = false;
  AddTurnTargets(*model_, turns, options_.best, extra);
  MoveOrigin(origin_m_, extra);
  for (int i = 0; i < extra.count; ++i) targets_.Add(extra.points[static_cast<std::size_t>(i)]);
}

void PaperEstimate::Start(const momentum::TPose& pose, const Eigen::Vector3d& origin_m) {
  estimator_.emplace(config_, model_->subject, pose, step_s_);
  if (model_->horizontal) horizontal_.emplace(*model_->horizontal, pose, step_s_);
  origin_m_ = origin_m;
}

Measurement PaperEstimate::Advance(const Inputs& inputs) {
  std::optional<Eigen::Vector2d> com_m;
  if (horizontal_) com_m = horizontal_->Advance(inputs.loads);
  return {UsableHands(inputs.hands, origin_m_), UsableArms(inputs.arms),
          estimator_->Advance(inputs.loads, com_m)};
}

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
  angles_.Start();
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
  angles_.Advance(state.options.best, solver);
  output.angle_sd_rad = angles_.Report(doubt, then.momentum, state.options.best);
  ReportCom(then.momentum, output);
  if (state.targets.has_com) {
    ReportPoseHeight(*state.model, state.pose.at, spread_.com_height_sd_m(), doubt, output);
  }
}

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

namespace {

pose::FibonacciOptions SearchOptions(const Options& options) {
  pose::FibonacciOptions search = options.paper.search;
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
  AddPaperHandTargets(*state_.model, now, state_.options.paper, state_.targets);
  if (truth.feet) {
    AddFeetTargets(*state_.model, *truth.feet, state_.targets);
  } else {
    AddPaperFeetTargets(*state_.model, now, state_.options.paper, state_.targets);
  }
  ShowFeet(*state_.model, state_.targets, state_.shown_feet);
  SetPaperMomentumTargets(*state_.model, now, mass_kg, state_.options, state_.targets);
  OverrideMomentumTargets(truth, state_.options, state_.targets);
  state_.MoveTargets();
}

namespace {

constexpr double kTrueFootSdM = 0.015, kTrueComSdM = 0.01, kTrueAngularSd = 1;
constexpr double kHingeM = 0.25;   // Distance at which a turn of the upper arm counts as a length.
constexpr double kSegmentM = 0.2;  // The same of worn sensors; any length makes the same terms.

pose::PointTarget FistTarget(const body::Point& fist, const HandInput& hand,
                             const Eigen::Vector3d& sd_m) {
  return {fist.joint, fist.p_J_m, hand.p_W_m,
          sd_m,       -1,         pose::WhiteningOf(sd_m, hand.covariance_m2)};
}

/// Three targets, of unit vectors times lengths; `sd_m` maps length and deviation to a deviation.
template <typename SdM>
void AddArmTargets(const arms::ArmGeometry& arm, const arms::ArmEstimate& estimate, SdM sd_m,
                   pose::PoseTargets& targets) {
  if (!estimate.valid) return;
  const auto add = [&](int joint, const Eigen::Vector3d& p_J_m, int from, double length_m,
                       const Eigen::Vector3d& direction, const Eigen::Vector3d& sd) {
    targets.Add({joint, p_J_m, length_m * direction, sd_m(length_m, sd), from});
  };
  const arms::ArmDirections& directions = estimate.directions;
  add(arm.elbow, Eigen::Vector3d::Zero(), arm.shoulder, arm.upper_m, directions.upper,
      estimate.upper_sd);
  add(arm.shoulder, kHingeM * arm.hinge_J, arm.shoulder, kHingeM, directions.hinge,
      estimate.hinge_sd);
  add(arm.fist.joint, arm.fist.p_J_m, arm.elbow, arm.forearm_m, directions.forearm,
      estimate.forearm_sd);
}

void AddJoints(const FootGeometry& geometry, const Eigen::Vector3d& ankle_W_m, double ankle_sd_m,
               const Eigen::Vector3d& toe_W_m, double toe_sd_m, pose::PoseTargets& targets) {
  targets.Add({geometry.ankle.joint, geometry.ankle.p_J_m, ankle_W_m,
               Eigen::Vector3d::Constant(ankle_sd_m)});
  targets.Add(
      {geometry.toe.joint, geometry.toe.p_J_m, toe_W_m, Eigen::Vector3d::Constant(toe_sd_m)});
}

Eigen::Vector3d AngularTarget(const SubjectModel& model, const Measurement& then, double mass_kg) {
  return then.momentum.angular_momentum_kgm2ps * (model.body.mass_kg / mass_kg);
}

}  // namespace

void AddHandTargets(const SubjectModel& model, const Measurement& then, const BestConstants& best,
                    pose::PoseTargets& targets) {
  const auto arm_sd_m = [&](double length_m, const Eigen::Vector3d& sd) {
    return Eigen::Vector3d(length_m * best.arm_spread * sd);
  };
  for (std::size_t side = 0; side < kHands; ++side) {
    const HandInput& hand = then.hands[side];
    if (!hand.valid) {
      AddArmTargets(model.arms[side], then.arms[side], arm_sd_m, targets);
      continue;
    }
    targets.Add(FistTarget(model.fists[side], hand,
                           (hand.sd_m.array().square() + std::pow(best.hand_sd_m, 2)).sqrt()));
  }
}

void AddPaperHandTargets(const SubjectModel& model, const Measurement& then,
                         const PaperConstants& constants, pose::PoseTargets& targets) {
  const auto arm_sd_m = [&](double length_m, const Eigen::Vector3d&) {
    return Eigen::Vector3d(Eigen::Vector3d::Constant(length_m * constants.arm_sd_rad));
  };
  for (std::size_t side = 0; side < kHands; ++side) {
    const HandInput& hand = then.hands[side];
    if (!hand.valid) {
      AddArmTargets(model.arms[side], then.arms[side], arm_sd_m, targets);
      continue;
    }
    const body::Point& fist = model.fists[side];
    targets.Add(
        {fist.joint, fist.p_J_m, hand.p_W_m, Eigen::Vector3d::Constant(constants.hand_sd_m)});
  }
}

void AddTurnTargets(const SubjectModel& model, const BodyTurns& turns, const BestConstants& best,
                    pose::PoseTargets& targets) {
  for (std::size_t site = 0; site < kBodySites; ++site) {
    const arms::HandState& turned = turns[site];
    if (!turned.valid) continue;
    const int joint = model.body.landmarks[JointOf(static_cast<BodySite>(site))];
    if (joint < 0) continue;  // This skeleton has none.
    const Eigen::Matrix3d R_JW =
        (turned.turn_W * model.t_pose_at.R_WJ[static_cast<std::size_t>(joint)]).transpose();
    const double own_rad =
        IsHand(static_cast<BodySite>(site)) ? best.hand_turn_sd_rad : best.segment_sd_rad;
    const double lean_m = kSegmentM * std::hypot(turned.inclination_sd_rad, own_rad);
    const double turn_m = kSegmentM * std::hypot(turned.heading_sd_rad, own_rad);
    // A device whose heading is off shows a bend to another side than where it goes: the error is
    // across the bend, and the larger the deeper it is.
    const Eigen::Vector3d up_W = turned.turn_W.col(2);
    const Eigen::Vector2d across_m =
        kSegmentM * turned.heading_sd_rad * Eigen::Vector2d(up_W.y(), -up_W.x());
    const Eigen::Vector3d sd_m(std::hypot(lean_m, across_m.x()), std::hypot(lean_m, across_m.y()),
                               lean_m);
    targets.Add({joint, kSegmentM * R_JW.col(2), kSegmentM * Eigen::Vector3d::UnitZ(), sd_m, joint,
                 pose::WhiteningOf(sd_m, {across_m.x() * across_m.y(), 0, 0})});
    // How far it points up is the inclination's, which the first one has.
    targets.Add({joint,
                 kSegmentM * R_JW.col(0),
                 kSegmentM * Eigen::Vector3d::UnitX(),
                 {turn_m, turn_m, kUnknownSdM},
                 joint});
  }
}

void AddFeetTargets(const SubjectModel& model, const Measurement& then, const FootSpread& spread,
                    pose::PoseTargets& targets) {
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    AddFootTargets(model.feet[f], then.momentum.feet[f], spread, targets);
  }
}

void AddPaperFeetTargets(const SubjectModel& model, const Measurement& then,
                         const PaperConstants& constants, pose::PoseTargets& targets) {
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    AddPaperFootTargets(model.feet[f], then.momentum.feet[f], constants.foot_sd_m, targets);
  }
}

void AddFeetTargets(const SubjectModel& model, const std::array<FootPrior, momentum::kFeet>& feet,
                    pose::PoseTargets& targets) {
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    AddJoints(model.feet[f], feet[f].ankle_W_m, feet[f].ankle_sd_m, feet[f].toe_W_m,
              feet[f].toe_sd_m, targets);
  }
}

void AddFeetTargets(const SubjectModel& model, const std::array<Truth::Foot, momentum::kFeet>& feet,
                    pose::PoseTargets& targets) {
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    AddJoints(model.feet[f], feet[f].ankle_W_m, kTrueFootSdM, feet[f].toe_W_m, kTrueFootSdM,
              targets);
  }
}

void SetMomentumTargets(const SubjectModel& model, const Measurement& then, double mass_kg,
                        const Options& options, pose::PoseTargets& targets) {
  const momentum::Estimate& estimate = then.momentum;
  targets.has_com = options.use_momentum;
  targets.com_W_m = estimate.p_WC_m;
  targets.com_sd_m =
      (estimate.position_variance_m2.array() + std::pow(options.best.com_sd_m, 2)).sqrt();
  if (!estimate.trusted) targets.com_sd_m.z() = kUnknownSdM;
  if (!estimate.whole_weight) targets.com_sd_m.setConstant(kUnknownSdM);
  targets.has_angular = options.use_angular_momentum && options.best.angular_sd > 0;
  targets.angular_W = AngularTarget(model, then, mass_kg);
  targets.angular_sd =
      (estimate.angular_momentum_variance.array() + std::pow(options.best.angular_sd, 2)).sqrt();
}

void SetPaperMomentumTargets(const SubjectModel& model, const Measurement& then, double mass_kg,
                             const Options& options, pose::PoseTargets& targets) {
  targets.has_com = options.use_momentum;
  targets.com_W_m = then.momentum.p_WC_m;
  const PaperConstants& constants = options.paper;
  targets.com_sd_m << constants.com_sd_m, constants.com_sd_m, constants.height_sd_m;
  targets.has_angular = options.use_angular_momentum;
  targets.angular_W = AngularTarget(model, then, mass_kg);
  targets.angular_sd.setConstant(constants.angular_sd);
}

void SetMomentumTargets(const std::optional<WalkPrior::Com>& com, pose::PoseTargets& targets) {
  targets.has_angular = false;
  targets.has_com = com.has_value();
  if (!com) return;
  targets.com_W_m = com->p_W_m;
  targets.com_sd_m = com->sd_m;
}

void OverrideMomentumTargets(const Truth& truth, const Options& options,
                             pose::PoseTargets& targets) {
  const bool paper = options.mode == Mode::kPaper;
  if (truth.com_W_m) {
    targets.has_com = true;
    targets.com_W_m = *truth.com_W_m;
    targets.com_sd_m.setConstant(paper ? options.paper.true_com_sd_m : kTrueComSdM);
  }
  if (truth.angular_W) {
    targets.has_angular = options.use_angular_momentum;
    targets.angular_W = *truth.angular_W;
    targets.angular_sd.setConstant(paper ? options.paper.true_angular_sd : kTrueAngularSd);
  }
}

void Clear(pose::PoseTargets& targets) {
  targets.count = 0;
  targets.has_com = targets.has_angular = false;
  targets.com_W_m.setZero();
}

void MoveOrigin(const Eigen::Vector3d& origin_m, pose::PoseTargets& targets) {
  for (int i = 0; i < targets.count; ++i) {
    pose::PointTarget& point = targets.points[static_cast<std::size_t>(i)];
    if (point.from_joint < 0) point.p_W_m -= origin_m;
  }
  targets.com_W_m -= origin_m;
}

std::optional<FootPoints> PointsOf(const FootGeometry& foot, const pose::PoseTargets& targets) {
  FootPoints points;
  std::size_t count = 0;
  for (int i = 0; i < targets.count && count < points.size(); ++i) {
    const pose::PointTarget& point = targets.points[static_cast<std::size_t>(i)];
    if (point.joint == foot.ankle.joint || point.joint == foot.toe.joint) points[count++] = point;
  }
  if (count < points.size()) return std::nullopt;
  return points;
}

}  // namespace footing::reconstruction
