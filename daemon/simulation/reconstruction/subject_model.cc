#include "daemon/simulation/reconstruction/subject_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/body/skeleton_points.h"
#include "daemon/simulation/momentum/horizontal_com.h"

namespace footing::reconstruction {
namespace {

constexpr double kHeelBehindM = 0.045;  // Behind the ankle, as the soles of common/virtual/devices.
constexpr double kMostSpreadM = 0.6;
constexpr double kToeOutRad = DegreesToRadians(7);

body::Kinematics InTPose(const body::Body& body) {
  body::Kinematics at(body.skeleton);
  body::ComputeKinematics(body.skeleton, body::TPose(body.skeleton, body.landmarks), at);
  return at;
}

pose::PointTarget Target(const body::Point& point, const Eigen::Vector3d& p_W_m,
                         const Eigen::Vector3d& sd_m) {
  return {point.joint, point.p_J_m, p_W_m, sd_m};
}

}  // namespace

std::array<FootGeometry, momentum::kFeet> StandingFeet(const body::Body& body) {
  const body::Kinematics at = InTPose(body);
  std::array<FootGeometry, momentum::kFeet> feet;
  for (int side = 0; side < 2; ++side) {
    FootGeometry& foot = feet[static_cast<std::size_t>(side)];
    foot.ankle = body::Ankle(body, side);
    foot.toe = body::Toe(body, side);
    const Eigen::Vector3d ankle = body::Place(foot.ankle, at), toe = body::Place(foot.toe, at);
    const Eigen::Vector3d tip = body::Place(body::ToeEnd(body, side), at);
    const Eigen::Vector2d along = (tip - ankle).head<2>();
    momentum::FootShape& shape = foot.shape;
    if (along.norm() > 0.02) {
      shape.yaw_rad = std::atan2(along.y(), along.x());
      shape.length_m = along.norm() + kHeelBehindM;
    }
    const Eigen::Matrix3d R_WS = body::AxisRotation(body::Axis::kZ, shape.yaw_rad);
    const double outwards = side == 0 ? 1 : -1;
    shape.yaw_rad = outwards * std::max(outwards * shape.yaw_rad, kToeOutRad);
    foot.R_WF = body::AxisRotation(body::Axis::kZ, shape.yaw_rad);
    const double to_rest_m = shape.rest_share * shape.length_m - kHeelBehindM;
    foot.ankle_F_m = {-to_rest_m, 0, ankle.z()};
    foot.toe_F_m = foot.ankle_F_m + R_WS.transpose() * (toe - ankle);
    const Eigen::Matrix3d& R_WJ = at.R_WJ[static_cast<std::size_t>(foot.ankle.joint)];
    foot.heel = foot.ankle;
    foot.heel.p_J_m += R_WJ.transpose() * R_WS * Eigen::Vector3d(-kHeelBehindM, 0, -ankle.z());
  }
  return feet;
}

momentum::Subject SubjectOf(const body::Body& body) {
  momentum::Subject subject;
  subject.com_height_m = body::CentreOfMass(body, InTPose(body)).z();
  const auto feet = StandingFeet(body);
  for (std::size_t f = 0; f < feet.size(); ++f) subject.feet[f] = feet[f].shape;
  return subject;
}

void AddFootTargets(const FootGeometry& geometry, const momentum::FootEstimate& foot,
                    const FootSpread& spread, pose::PoseTargets& targets) {
  if (!foot.valid) return;
  const double aloft_s = foot.contact ? 0 : foot.airborne_s;
  const double off = 1 - std::exp(-aloft_s / spread.lift_time_s);  // 0 on the ground, 1 in the air.
  const Eigen::Vector3d place =
      foot.p_WF_m + geometry.R_WF * Eigen::Vector3d(off * spread.forward, 0, off * spread.lift);
  // W's axes serve as the foot's: a foot points ahead, more or less.
  const auto sd = [&](double up_m) {
    const Eigen::Array3d own(spread.along, spread.across, up_m);
    const Eigen::Array3d air(spread.air_level, spread.air_level, spread.air_up);
    const Eigen::Array3d all =
        foot.variance_m2.array() * Eigen::Array3d(1, 1, 0) + own.square() + (off * air).square();
    return Eigen::Vector3d(all.sqrt().min(kMostSpreadM));
  };
  const auto up = [&](double rise_m) { return Eigen::Vector3d(0, 0, (1 - off) * rise_m); };
  targets.Add(Target(geometry.ankle,
                     place + geometry.R_WF * geometry.ankle_F_m + up(spread.ankle_rise),
                     sd(spread.ankle_up)));
  targets.Add(Target(geometry.toe, place + geometry.R_WF * geometry.toe_F_m + up(spread.toe_rise),
                     sd(spread.toe_up)));
}

void AddPaperFootTargets(const FootGeometry& geometry, const momentum::FootEstimate& foot,
                         double sd_m, pose::PoseTargets& targets) {
  if (!foot.valid) return;
  const Eigen::Vector3d sd = Eigen::Vector3d::Constant(sd_m);
  targets.Add(Target(geometry.ankle, foot.p_WF_m + geometry.R_WF * geometry.ankle_F_m, sd));
  targets.Add(Target(geometry.toe, foot.p_WF_m + geometry.R_WF * geometry.toe_F_m, sd));
}

namespace {

constexpr int kSolverIterations = 2;
constexpr int kPostureIterations = 1;

}  // namespace

int Options::lag_steps() const { return static_cast<int>(std::lround(lag_s * rate_hz)); }

std::string NameOf(Mode mode) { return mode == Mode::kPaper ? "paper" : "best"; }

namespace {

struct Part {
  const char* name;
  bool Options::*used;
};

constexpr std::array kParts{
    Part{"angular_momentum", &Options::use_angular_momentum},
    Part{"momentum", &Options::use_momentum}, Part{"posture", &Options::use_posture},
    Part{"basis", &Options::use_basis}, Part{"cleanup", &Options::clean_up}};

}  // namespace

Result<void> LeaveOut(const std::vector<std::string>& parts, Options& options) {
  for (const Part& part : kParts) options.*part.used = true;
  for (const std::string& name : parts) {
    const auto found = std::find_if(kParts.begin(), kParts.end(),
                                    [&](const Part& part) { return part.name == name; });
    if (found == kParts.end()) {
      std::vector<std::string> names;
      for (const Part& part : kParts) names.emplace_back(part.name);
      return UsageError("unknown part " + name +
                        " of the reconstruction; there are: " + text::Joined(names));
    }
    options.*found->used = false;
  }
  return {};
}

std::vector<std::string> LeftOut(const Options& options) {
  std::vector<std::string> names;
  for (const Part& part : kParts) {
    if (!(options.*part.used)) names.emplace_back(part.name);
  }
  return names;
}

Result<void> SetMode(const std::string& name, const std::vector<std::string>& left_out,
                     Options& options) {
  if (name != "best" && name != "paper") {
    return UsageError("unknown mode " + name + "; there are: best, paper");
  }
  options.mode = name == "paper" ? Mode::kPaper : Mode::kBest;
  return LeaveOut(left_out, options);
}

Result<void> CheckOptions(const Options& options) {
  if (!(options.rate_hz >= 20 && options.rate_hz <= 240)) {
    return UsageError("pose: a rate of " + std::to_string(options.rate_hz) +
                      " Hz is outside of 20 to 240");
  }
  const double most_lag_s =
      std::min(0.2, (momentum::HorizontalCom::kSlots - 1) / options.rate_hz) + 1e-9;
  if (!(options.lag_s >= 0 && options.lag_s <= most_lag_s)) {
    return UsageError("pose: a lag of " + std::to_string(1000 * options.lag_s) +
                      " ms is outside of 0 to " + std::to_string(1000 * most_lag_s) +
                      " at this rate");
  }
  if (options.mode == Mode::kPaper && options.lag_s > 0) {
    return UsageError("pose: the paper mode has no lag");
  }
  return {};
}

pose::GaussNewtonOptions BasisSolverOptions(const Options& options) {
  pose::GaussNewtonOptions solver;
  solver.iterations = kSolverIterations;
  solver.prior_weight = options.best.prior_weight;
  solver.smooth_weight = options.best.smooth_weight * std::sqrt(options.rate_hz / 60);
  solver.frame_s = options.step_s();
  return solver;
}

arms::SquatTurn SquatTurnOf(BodySite site) {
  // Means and spreads over five people's squats (docs/evaluation/pose.md): knees go outwards with
  // the toes, and shanks more so than thighs.
  constexpr double kThigh = 0.14, kThighSd = 0.16, kShank = 0.28, kShankSd = 0.24, kHeadSd = 0.2,
                   kGripSd = 0.1;
  switch (site) {
    case BodySite::kPelvis:
    case BodySite::kChest:
      return {};
    case BodySite::kHead:
      return {1, 0, kHeadSd};
    case BodySite::kLeftThigh:
      return {-1, kThigh, kThighSd};
    case BodySite::kRightThigh:
      return {-1, -kThigh, kThighSd};
    case BodySite::kLeftShank:
      return {1, kShank, kShankSd};
    case BodySite::kRightShank:
      return {1, -kShank, kShankSd};
    case BodySite::kLeftHand:
    case BodySite::kRightHand:
      return {0, 0, kGripSd};
  }
  return {};
}

body::Landmark JointOf(BodySite site) {
  switch (site) {
    case BodySite::kPelvis:
      return body::Landmark::kHips;
    case BodySite::kChest:
      return body::Landmark::kChest;
    case BodySite::kHead:
      return body::Landmark::kHead;
    case BodySite::kLeftThigh:
      return body::Landmark::kLeftHip;
    case BodySite::kRightThigh:
      return body::Landmark::kRightHip;
    case BodySite::kLeftShank:
      return body::Landmark::kLeftKnee;
    case BodySite::kRightShank:
      return body::Landmark::kRightKnee;
    case BodySite::kLeftHand:
      return body::Landmark::kLeftWrist;
    case BodySite::kRightHand:
      return body::Landmark::kRightWrist;
  }
  return body::Landmark::kHips;
}

pose::GaussNewtonOptions RegressedSolverOptions(const Options& options) {
  pose::GaussNewtonOptions solver = BasisSolverOptions(options);
  solver.prior_weight = options.best.regressed_prior_weight;
  solver.smooth_weight = options.best.regressed_smooth_weight * std::sqrt(options.rate_hz / 60);
  return solver;
}

pose::GaussNewtonOptions PostureSolverOptions(const Options& options) {
  pose::GaussNewtonOptions solver = BasisSolverOptions(options);
  solver.iterations = kPostureIterations;
  return solver;
}

namespace {

// Share of the variance, in the components that paper mode searches.

/// A landmark's joint on one side and the joints below it.
std::vector<std::size_t> JointsFrom(const body::Body& body, body::Landmark left, int side) {
  const int top = body.landmarks[side == 0 ? left : body::Mirrored(left)];
  std::vector<std::size_t> joints;
  for (int joint = 0; joint < body.skeleton.size(); ++joint) {
    int up = joint;
    while (up >= 0 && up != top) up = body.skeleton.joint(up).parent;
    if (up == top) joints.push_back(static_cast<std::size_t>(joint));
  }
  return joints;
}

Result<void> CheckLayout(const body::Body& body, const Models& models) {
  const std::vector<std::string> dofs = body::DofNames(body.skeleton);
  if (dofs == models.dofs) return {};
  std::size_t i = 0;
  while (i < std::min(dofs.size(), models.dofs.size()) && dofs[i] == models.dofs[i]) ++i;
  return InvalidData(models.origin + ": its poses have another layout than the body: " +
                     std::to_string(models.dofs.size()) + " degrees of freedom for " +
                     std::to_string(dofs.size()) +
                     (i < dofs.size() ? ", and no " + dofs[i] + " where the body has it" : "") +
                     "; train a basis of this layout");
}

/// All that does not depend on the mode; the basis has all components.
/// The pelvis tilts by 1 rad, and trunk and thighs stay.
Eigen::VectorXd PelvisAlone(const body::Body& body) {
  constexpr double kAbout = 0.8;  // Cosine of the largest angle between an axis and W's y.
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(body.skeleton.dof);
  const auto turn = [&](int index, double angle_rad) {
    const body::Joint& joint = body.skeleton.joint(index);
    int dof = joint.first_dof;
    for (const body::Rotation& rotation : joint.rotations) {
      const double along = joint.axes.col(static_cast<int>(rotation.axis)).y();
      if (std::abs(along) > kAbout) direction(dof) = along > 0 ? angle_rad : -angle_rad;
      ++dof;
    }
  };
  const int pelvis = body.landmarks[body::Landmark::kHips];
  turn(pelvis, 1);
  turn(body.landmarks[body::Landmark::kLeftHip], -1);
  turn(body.landmarks[body::Landmark::kRightHip], -1);
  int spine = body.landmarks[body::Landmark::kNeck];  // Its lowest joint.
  while (spine > 0 && body.skeleton.joint(spine).parent != pelvis) {
    spine = body.skeleton.joint(spine).parent;
  }
  turn(spine, -1);
  return direction;
}

Result<SubjectModel> CommonSubjectModel(const body::Body& body, const Models& models) {
  if (const auto checked = CheckLayout(body, models); !checked) return checked.error();
  SubjectModel model;
  model.body = body;
  model.t_pose = body::TPose(body.skeleton, body.landmarks);
  model.t_pose_at = body::Kinematics(body.skeleton);
  body::ComputeKinematics(body.skeleton, model.t_pose, model.t_pose_at);
  model.basis = models.root_height_m > 0
                    ? pose::Resized(models.basis, model.root_height_m() / models.root_height_m)
                    : models.basis;
  model.subject = SubjectOf(body);
  model.feet = StandingFeet(body);
  model.joints = body::SkeletonPoints(body);
  for (int side = 0; side < 2; ++side) {
    model.fists[static_cast<std::size_t>(side)] = body::Fist(body, side);
    model.shanks[static_cast<std::size_t>(side)] =
        JointsFrom(body, body::Landmark::kLeftKnee, side);
    model.arm_joints[static_cast<std::size_t>(side)] =
        JointsFrom(body, body::Landmark::kLeftShoulder, side);
    model.arms.emplace_back(body, side);
  }
  return model;
}

}  // namespace

Result<SubjectModel> WalkSubjectModel(const body::Body& body, const Models& models,
                                      const Options& options) {
  auto model = CommonSubjectModel(body, models);
  if (model && !options.use_basis) model->basis = pose::Unconnected(model->basis);
  return model;
}

Result<SubjectModel> BestSubjectModel(const body::Body& body, const Models& models,
                                      const Options& options) {
  auto model = WalkSubjectModel(body, models, options);
  if (!model || !options.use_basis) return model;
  const double size = model->root_height_m() / models.root_height_m;
  const Eigen::VectorXd pelvis = options.best.pelvis_sd_rad * PelvisAlone(body);
  if (options.use_momentum && !models.regression.empty()) {
    model->regression = models.regression;
    model->rest = pose::Widened(pose::Resized(models.rest, size), pelvis);
  }
  if (options.use_posture && !models.posture.empty()) {
    model->posture = {models.posture.regression,
                      pose::Widened(pose::Resized(models.posture.rest, size), pelvis)};
  }
  return model;
}

Result<SubjectModel> PaperSubjectModel(const body::Body& body, const Models& models,
                                       const Options& options) {
  auto model = CommonSubjectModel(body, models);
  if (!model) return model;
  model->basis = options.use_basis ? pose::Leading(model->basis, options.paper.variance_share)
                                   : pose::Unconnected(model->basis);
  model->horizontal = models.horizontal;
  return model;
}

pose::LegIk LegOf(const SubjectModel& model, std::size_t foot) {
  const body::Landmark hip =
      foot == 0 ? body::Landmark::kLeftHip : body::Mirrored(body::Landmark::kLeftHip);
  return {model.body, model.body.landmarks[hip], model.feet[foot].toe.joint};
}

Eigen::Vector3d BasisOrigin(const SubjectModel& model, const momentum::TPose& pose) {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    const FootGeometry& foot = model.feet[f];
    const Eigen::Vector3d middle_m =
        pose.p_WP_m[f] + 0.5 * foot.R_WF * (foot.ankle_F_m + foot.toe_F_m);
    origin_m.head<2>() += 0.5 * middle_m.head<2>();
  }
  return origin_m;
}

LikelyPosture::LikelyPosture(const SubjectModel& model, double step_s)
    : model_(&model),
      step_s_(step_s),
      features_(step_s, model.root_height_m(), model.body.mass_kg),
      workspace_(model.posture.regression.MakeWorkspace()),
      likely_q_(model.t_pose) {}

void LikelyPosture::Start() {
  features_ = Features(step_s_, model_->root_height_m(), model_->body.mass_kg);
}

void LikelyPosture::Advance(const std::array<Eigen::Vector3d, kHands>& hands_W_m,
                            const std::array<momentum::FootEstimate, momentum::kFeet>& feet) {
  const momentum::Estimate bare = WithoutLoads(feet, model_->subject.com_height_m);
  middle_W_m_ = bare.p_WC_m;
  features_.Advance(hands_W_m, bare);
}

const Eigen::VectorXd& LikelyPosture::Predict(const Eigen::Vector3d& origin_m) {
  model_->posture.regression.Predict(features_.values(), workspace_, likely_q_);
  likely_q_.head<3>() = likely_q_.head<3>() * model_->root_height_m() + middle_W_m_ - origin_m;
  return likely_q_;
}

namespace {

constexpr double kSpeedLastsS = 0.3;
/// m^2/s^3. With the time above, a hand's speed along an axis has a deviation of 1.7 m/s: of swings
/// of 0.3 m at 0.3 to 1.5 Hz, measured as by a Kinect, it leaves least error for all.
constexpr double kAcceleration = 20;
constexpr double kSpeedSdMps = 1;  // Speed of a hand of which nothing is known.
// Root mean squares over 0.1 s of CMU 13 and 14 in place: hands 0.93 m/s, elbows 0.55, knees 0.34,
// all others 0.22 to 0.31. Hips that sink in a squat are faster, so all have the elbows' share.
constexpr double kJointsSpeedShare = 0.6;

}  // namespace

void HandTrack::Predict(double step_s) {
  const double acceleration = kAcceleration * speed_share_ * speed_share_;
  const double kept = std::exp(-step_s / kSpeedLastsS);
  const double way_s = kSpeedLastsS * (1 - kept);
  p_m_ += way_s * v_mps_;
  v_mps_ *= kept;
  pp_ += way_s * (2 * pv_ + way_s * vv_) + acceleration * std::pow(step_s, 3) / 3;
  pv_ = kept * (pv_ + way_s * vv_) + acceleration * step_s * step_s / 2;
  vv_ = kept * kept * vv_ + acceleration * step_s;
}

void HandTrack::Add(double time_s, const Eigen::Vector3d& p_W_m, const Eigen::Vector3d& sd_m,
                    const Eigen::Vector3d& covariance_m2) {
  const double step_s = time_s - time_s_;
  if (started_ && step_s <= 0 && step_s > -kFurthestS) return;
  measured_variance_ = sd_m.array().square();
  covariance_m2_ = covariance_m2;
  if (!started_ || std::abs(step_s) > kFurthestS) {
    p_m_ = p_W_m;
    v_mps_.setZero();
    pp_ = measured_variance_;
    pv_.setZero();
    vv_.setConstant(std::pow(speed_share_ * kSpeedSdMps, 2));
  } else {
    Predict(step_s);
    const Eigen::Array3d place_gain = pp_ / (pp_ + measured_variance_);
    const Eigen::Array3d speed_gain = pv_ / (pp_ + measured_variance_);
    const Eigen::Array3d off_m = p_W_m.array() - p_m_;
    p_m_ += place_gain * off_m;
    v_mps_ += speed_gain * off_m;
    vv_ -= speed_gain * pv_;
    pv_ *= 1 - place_gain;
    pp_ *= 1 - place_gain;
  }
  time_s_ = time_s;
  started_ = true;
}

HandInput HandTrack::At(double time_s) const {
  HandTrack later = *this;
  later.Predict(std::clamp(time_s - time_s_, 0.0, kFurthestS));
  HandInput hand;
  hand.valid = started_;
  hand.p_W_m = later.p_m_;
  hand.sd_m = (measured_variance_ + later.pp_ - pp_).sqrt();
  hand.covariance_m2 = covariance_m2_;
  return hand;
}

std::array<HandTrack, stream::kBodyJoints> JointTracks() {
  std::array<HandTrack, stream::kBodyJoints> tracks;
  tracks.fill(HandTrack(kJointsSpeedShare));
  return tracks;
}

namespace {

constexpr int kLeastJoints = 4;  // Fewest joints of a skeleton that shows more than a limb.
// Deviations from the pose of a moment ago, whitened by the joint's own covariance: of a joint that
// is right 3.5 are exceeded once in 140 looks (chi squared of three), 10 never.
constexpr double kDoubtedFrom = 3.5, kDroppedFrom = 10;
constexpr double kMostDroppedShare = 1.0 / 3;
// An offset of a Kinect changes over 5 s (virtual_sensors::KinectErrors), and a pose that also
// follows the joints shows a part of it only, so it is learned in less.
constexpr double kOffsetLearnedS = 1;
constexpr double kMostOffsetM = 0.3;  // Further off is a camera that was never placed.

pose::PointTarget TargetOf(const body::Point& point, const JointInput& joint) {
  return {point.joint, point.p_J_m, joint.p_W_m,
          joint.sd_m,  -1,          pose::WhiteningOf(joint.sd_m, joint.covariance_m2)};
}

void Widen(double factor, JointInput& joint) {
  joint.sd_m *= factor;
  joint.covariance_m2 *= factor * factor;
}

}  // namespace

bool IsSkeleton(const JointInputs& joints) {
  return std::count_if(joints.begin(), joints.end(),
                       [](const JointInput& joint) { return joint.valid; }) >= kLeastJoints;
}

void AddJointTargets(const JointPoints& points, const JointInputs& joints,
                     pose::PoseTargets& targets) {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].valid) targets.Add(TargetOf(points[i], joints[i]));
  }
}

void GateJoints(const JointPoints& points, const body::Kinematics& at, JointInputs& joints) {
  std::array<double, stream::kBodyJoints> off{};
  int seen = 0, dropped = 0;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (!joints[i].valid) continue;
    const pose::PointTarget target = TargetOf(points[i], joints[i]);
    off[i] = Whitened(target, target.p_W_m - PlaceOf(target, at)).norm();
    joints[i].valid = std::isfinite(off[i]);
    if (!joints[i].valid) continue;
    ++seen;
    if (off[i] > kDroppedFrom) ++dropped;
  }
  const bool drops = dropped <= kMostDroppedShare * seen;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (!joints[i].valid || off[i] <= kDoubtedFrom) continue;
    joints[i].valid = off[i] <= kDroppedFrom || !drops;
    Widen(off[i] / kDoubtedFrom, joints[i]);
  }
}

Inputs SkeletonOffset::Without(const Inputs& inputs) const {
  Inputs corrected = inputs;
  for (JointInput& joint : corrected.joints) joint.p_W_m -= offset_m_;
  for (HandInput& hand : corrected.hands) {
    if (hand.of_skeleton) hand.p_W_m -= offset_m_;
  }
  return corrected;
}

void SkeletonOffset::Learn(const JointPoints& points, const JointInputs& joints,
                           const body::Kinematics& at, double step_s) {
  if (!IsSkeleton(joints)) return;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), weights = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (!joints[i].valid) continue;
    const Eigen::Vector3d weight = joints[i].sd_m.cwiseAbs2().cwiseInverse();
    const Eigen::Vector3d off_m = joints[i].p_W_m - body::Place(points[i], at);
    sum += weight.cwiseProduct(off_m);
    weights += weight;
  }
  if (!(weights.minCoeff() > 0)) return;
  const double share = std::min(1.0, step_s / kOffsetLearnedS);
  const Eigen::Vector3d next_m = offset_m_ + share * sum.cwiseQuotient(weights);
  if (next_m.allFinite()) offset_m_ = next_m.cwiseMax(-kMostOffsetM).cwiseMin(kMostOffsetM);
}

namespace {

constexpr double kFarthestSeatM = 0.35;  // Further off is a camera that was never placed.
constexpr double kLeastShare = 0.5;
constexpr double kSureSdM = 0.025;  // Root mean square of the axes.

}  // namespace

bool HeadSeat::IsLone(const JointInputs& joints) {
  const JointInput& head = joints[kHeadJoint];
  return head.valid && head.sd_m.squaredNorm() <= 3 * kSureSdM * kSureSdM && !IsSkeleton(joints);
}

void HeadSeat::Start(const body::Point& middle) {
  *this = {};
  middle_ = point_ = middle;
}

void HeadSeat::See(const JointInputs& joints, const body::Kinematics& at, double step_s) {
  if (!Seeks()) return;
  sought_s_ += step_s;
  if (IsLone(joints)) {
    const JointInput& head = joints[kHeadJoint];
    const auto joint = static_cast<std::size_t>(middle_.joint);
    seen_s_ += step_s;
    sum_J_m_ += step_s * (at.R_WJ[joint].transpose() * (head.p_W_m - at.p_WJ[joint]));
  }
  if (Seeks() || seen_s_ < kLeastShare * sought_s_) return;
  const Eigen::Vector3d seat_m = sum_J_m_ / seen_s_;
  found_ = (seat_m - middle_.p_J_m).norm() <= kFarthestSeatM;
  if (found_) point_.p_J_m = seat_m;
}

}  // namespace footing::reconstruction
