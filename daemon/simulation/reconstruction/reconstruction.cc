#include "daemon/simulation/reconstruction/reconstruction.h"

#include <algorithm>
#include <cmath>

#include "common/body/momentum.h"

namespace footing::reconstruction {
namespace {

constexpr double kPaperShare =
    0.99;  // Of the variance, in the components that paper mode searches.
constexpr int kSolverIterations = 2;
constexpr int kPostureIterations = 1;
constexpr int kCleanUpIterations = 2;
constexpr double kUnknownSdM = 1.0;  // Before anything is measured.

pose::GaussNewtonOptions SolverOptions(const Options& options) {
  pose::GaussNewtonOptions solver;
  solver.iterations = kSolverIterations;
  solver.prior_weight = options.best.prior_weight;
  solver.smooth_weight = options.best.smooth_weight * std::sqrt(options.rate_hz / 60);
  solver.frame_s = 1 / options.rate_hz;
  return solver;
}

pose::GaussNewtonOptions RegressedOptions(const Options& options) {
  pose::GaussNewtonOptions solver = SolverOptions(options);
  solver.prior_weight = options.best.regressed_prior_weight;
  solver.smooth_weight = options.best.regressed_smooth_weight * std::sqrt(options.rate_hz / 60);
  return solver;
}

pose::GaussNewtonOptions PostureOptions(const Options& options) {
  pose::GaussNewtonOptions solver = SolverOptions(options);
  solver.iterations = kPostureIterations;
  return solver;
}

pose::FibonacciOptions SearchOptions(const Options& options) {
  pose::FibonacciOptions search;
  search.frame_s = 1 / options.rate_hz;
  return search;
}

pose::LegIk Leg(const body::Body& body, const FootGeometry& foot, int side) {
  const body::Landmark hip =
      side == 0 ? body::Landmark::kLeftHip : body::Mirrored(body::Landmark::kLeftHip);
  return {body, body.landmarks[hip], foot.toe.joint};
}

/// The knee of one side and the joints that it carries.
std::vector<std::size_t> Shank(const body::Body& body, int side) {
  const int knee = body.landmarks[side == 0 ? body::Landmark::kLeftKnee
                                            : body::Mirrored(body::Landmark::kLeftKnee)];
  std::vector<std::size_t> joints;
  for (int joint = 0; joint < body.skeleton.size(); ++joint) {
    int up = joint;
    while (up >= 0 && up != knee) up = body.skeleton.joint(up).parent;
    if (up == knee) joints.push_back(static_cast<std::size_t>(joint));
  }
  return joints;
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

}  // namespace

Result<Reconstruction> Reconstruction::Create(const body::Body& body, const Models& models,
                                              const Options& options) {
  if (const auto checked = CheckOptions(options); !checked) return checked.error();
  const std::vector<std::string> dofs = body::DofNames(body.skeleton);
  if (dofs != models.dofs) {
    std::size_t i = 0;
    while (i < std::min(dofs.size(), models.dofs.size()) && dofs[i] == models.dofs[i]) ++i;
    return InvalidData(models.origin + ": its poses have another layout than the body: " +
                       std::to_string(models.dofs.size()) + " degrees of freedom for " +
                       std::to_string(dofs.size()) +
                       (i < dofs.size() ? ", and no " + dofs[i] + " where the body has it" : "") +
                       "; train a basis of this layout");
  }
  auto parts = std::make_shared<Parts>();
  parts->body = body;
  parts->t_pose = body::TPose(body.skeleton, body.landmarks);
  parts->basis = models.root_height_m > 0
                     ? pose::Resized(models.basis, parts->t_pose(2) / models.root_height_m)
                     : models.basis;
  const pose::PoseBasis full = parts->basis;
  if (options.mode == Mode::kPaper) parts->basis = pose::Leading(parts->basis, kPaperShare);
  if (!options.use_basis) parts->basis = pose::Unconnected(full);
  parts->subject = SubjectOf(body);
  parts->feet = StandingFeet(body);
  for (int side = 0; side < 2; ++side) {
    parts->fists[static_cast<std::size_t>(side)] = body::Fist(body, side);
    parts->shanks[static_cast<std::size_t>(side)] = Shank(body, side);
    parts->arms.emplace_back(body, side);
  }
  parts->horizontal = models.horizontal;
  if (options.mode == Mode::kBest && options.use_basis && options.use_momentum &&
      !models.regression.empty()) {
    parts->regression = models.regression;
    parts->rest = pose::Resized(models.rest, parts->t_pose(2) / models.root_height_m);
  }
  return Reconstruction(std::move(parts), options);
}

Reconstruction::Reconstruction(std::shared_ptr<const Parts> parts, const Options& options)
    : parts_(std::move(parts)),
      options_(options),
      step_s_(1 / options.rate_hz),
      lag_steps_(static_cast<int>(std::lround(options.lag_s * options.rate_hz))),
      features_(step_s_, parts_->t_pose(2), parts_->body.mass_kg),
      gauss_newton_(parts_->body, parts_->basis, SolverOptions(options)),
      posture_(parts_->body, parts_->basis, PostureOptions(options)),
      fibonacci_(parts_->body, parts_->basis, SearchOptions(options)),
      legs_{Leg(parts_->body, parts_->feet[0], 0), Leg(parts_->body, parts_->feet[1], 1)},
      q_(parts_->t_pose),
      at_(parts_->body.skeleton) {
  if (!parts_->regression.empty()) {
    regressed_.emplace(parts_->body, parts_->rest, RegressedOptions(options));
    room_ = parts_->regression.MakeRoom();
    likely_q_ = parts_->t_pose;
  }
  const auto joints = static_cast<std::size_t>(parts_->body.skeleton.size());
  output_.q = q_;
  output_.R_WJ.resize(joints);
  output_.p_WJ_m.resize(joints);
  output_.joint_sd_m.assign(joints, kUnknownSdM);
  linear_sd_m_.assign(joints, kUnknownSdM);
  Recalibrate();
}

void Reconstruction::Recalibrate() {
  calibration_ = {};
  best_.reset();
  paper_.reset();
  horizontal_.reset();
  frames_ = 0;
  output_.calibrated = false;
  output_.calibration_progress = 0;
  output_.valid = false;
  output_.lag_s = lag_steps_ * step_s_;
  output_.mass_kg = parts_->body.mass_kg;
  output_.momentum = {};
  body::ComputeKinematics(parts_->body.skeleton, parts_->t_pose, at_);
  Tell(parts_->t_pose);
  output_.com_W_m = body::CentreOfMass(parts_->body, at_);
  output_.com_variance_m2.setConstant(kUnknownSdM * kUnknownSdM);
  com_height_sd_m_ = kUnknownSdM;
  std::fill(output_.joint_sd_m.begin(), output_.joint_sd_m.end(), kUnknownSdM);
  std::fill(linear_sd_m_.begin(), linear_sd_m_.end(), kUnknownSdM);
}

void Reconstruction::Begin(const momentum::TPose& pose) {
  if (options_.mode == Mode::kBest) {
    momentum::BestConfig config;
    config.lag_s = lag_steps_ * step_s_;
    best_.emplace(config, parts_->subject, pose, step_s_);
  } else {
    paper_.emplace(momentum::PaperConfig{}, parts_->subject, pose, step_s_);
    if (parts_->horizontal) horizontal_.emplace(*parts_->horizontal, pose, step_s_);
  }
  gauss_newton_.Reset();
  posture_.Reset();
  fibonacci_.Reset();
  if (regressed_) regressed_->Reset();
  was_regressed_ = placed_by_arms_ = false;
  locks_.fill(FootLock());
  features_ = Features(step_s_, parts_->t_pose(2), pose.mass_kg);
  for (std::size_t side = 0; side < kHands; ++side) {
    last_hands_m_[side] = output_.p_WJ_m[static_cast<std::size_t>(parts_->fists[side].joint)];
  }
  // Poses were learned with the middle of the feet over the origin.
  origin_m_.setZero();
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    const FootGeometry& foot = parts_->feet[f];
    const Eigen::Vector3d middle_m =
        pose.p_WP_m[f] + 0.5 * foot.R_WF * (foot.ankle_F_m + foot.toe_F_m);
    origin_m_.head<2>() += 0.5 * middle_m.head<2>();
  }
  output_.mass_kg = pose.mass_kg;
  output_.calibrated = true;
}

const Output& Reconstruction::Advance(const Inputs& inputs) {
  if (std::isfinite(inputs.loads.time_s)) output_.time_s = inputs.loads.time_s;
  if (!output_.calibrated) {
    const bool done = calibration_.Advance(inputs.loads, step_s_);
    output_.calibration_progress = calibration_.progress();
    output_.calibration_restarts = calibration_.restarts();
    if (done) Begin(calibration_.result());
    return output_;
  }
  output_.momentum = best_ ? best_->Advance(inputs.loads)
                           : paper_->Advance(inputs.loads, PredictHorizontal(inputs.loads));
  if (best_) output_.mass_kg = best_->mass_kg();
  output_.resets = output_.momentum.resets + solver_resets_;
  output_.valid = output_.momentum.valid;
  Remember(inputs);
  TakeLagged();
  PlaceTargets();
  PlaceHandsByArms();
  AdvanceFeatures();
  Solve();
  return output_;
}

std::optional<Eigen::Vector2d> Reconstruction::PredictHorizontal(
    const momentum::ContactLoads& loads) {
  if (!horizontal_) return std::nullopt;
  return horizontal_->Advance(loads);
}

void Reconstruction::Solve() {
  const bool paper = options_.mode == Mode::kPaper;
  if (paper) {
    fibonacci_.Solve(targets_);
    q_ = fibonacci_.q();
    body::ComputeKinematics(parts_->body.skeleton, q_, at_);
  } else {
    SolveBest();
  }
  if (options_.clean_up) CleanUp();
  if (!q_.allFinite()) {
    gauss_newton_.Reset();
    fibonacci_.Reset();
    if (regressed_) regressed_->Reset();
    output_.valid = false;
    ++solver_resets_;
    return;
  }
  q_.head<3>() += origin_m_;
  for (Eigen::Vector3d& p_WJ : at_.p_WJ) p_WJ += origin_m_;
  Tell(q_);
  if (!paper) {
    TellFit();
    TellSpreads();
  }
  TellCom();
}

/// The regression has seen both hands at all times.
bool Reconstruction::Regressed() const {
  return regressed_ && (then_.hands[0].valid || then_.arms[0].valid) &&
         (then_.hands[1].valid || then_.arms[1].valid);
}

void Reconstruction::PlaceHandsByArms() {
  const bool followed = placed_by_arms_ || !was_regressed_;
  placed_by_arms_ = Regressed() && !(then_.hands[0].valid && then_.hands[1].valid);
  if (!placed_by_arms_) return;
  if (!followed) gauss_newton_.ContinueFrom(regressed_->q());
  gauss_newton_.Solve(targets_);
  body::ComputeKinematics(parts_->body.skeleton, gauss_newton_.q(), at_);
  for (std::size_t side = 0; side < kHands; ++side) {
    const body::Point& fist = parts_->fists[side];
    const auto joint = static_cast<std::size_t>(fist.joint);
    last_hands_m_[side] = origin_m_ + body::Place(fist, at_.R_WJ[joint], at_.p_WJ[joint]);
  }
}

void Reconstruction::SolveBest() {
  const bool regressed = Regressed();
  pose::GaussNewton& solver = regressed ? *regressed_ : gauss_newton_;
  if (regressed != was_regressed_ && frames_ > 1) {
    solver.ContinueFrom(regressed ? gauss_newton_.q() : regressed_->q());
  }
  was_regressed_ = regressed;
  if (regressed) {
    parts_->regression.Predict(features_.values(), room_, likely_q_);
    likely_q_.head<3>() =
        likely_q_.head<3>() * parts_->t_pose(2) + then_.momentum.p_WC_m - origin_m_;
    solver.Solve(targets_, likely_q_);
  } else {
    solver.Solve(targets_);
  }
  q_ = solver.q();
  at_ = solver.at();
}

void Reconstruction::CleanUp() {
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    if (then_.momentum.feet[f].contact || then_.known.feet || options_.mode == Mode::kPaper) {
      legs_[f].Solve(standing_, kCleanUpIterations, q_, at_);
    }
  }
}

}  // namespace footing::reconstruction
