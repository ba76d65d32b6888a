#include "daemon/simulation/reconstruction/reconstruction.h"

#include <algorithm>
#include <cmath>

namespace footing::reconstruction {
namespace {

constexpr double kPaperShare =
    0.99;  // Of the variance, in the components that paper mode searches.
constexpr double kPaperHandSdM = 0.012, kPaperFootSdM = 0.02;
constexpr double kPaperComSdM = 0.03, kPaperHeightSdM = 0.05, kPaperAngularSd = 2;
constexpr double kStartSd = 0.1;  // Of the T-pose's coordinates: nobody stands quite like it.
constexpr int kCleanUpIterations = 4;
constexpr int kSpreadsAFrame = 3;    // Joints whose covariance is told anew in each frame.
constexpr double kUnknownSdM = 1.0;  // Before anything is measured.
constexpr double kKnownComSdM = 0.01, kKnownAngularSd = 1;
constexpr double kMostHandM = 10;  // Nobody's hand is further from the cells.

/// The same poses of a person whose root is so many times as high: angles stay.
pose::PoseBasis Resized(pose::PoseBasis basis, double scale) {
  basis.mean.head<3>() *= scale;
  basis.modes.topRows<3>() *= scale;
  basis.inverse.leftCols<3>() /= scale;
  return basis;
}

/// The components that hold this share of the variance.
pose::PoseBasis Leading(pose::PoseBasis basis, double share) {
  const double total = basis.sd.squaredNorm();
  Eigen::Index count = 0;
  double sum = 0;
  while (count < basis.sd.size() && sum < share * total) sum += std::pow(basis.sd(count++), 2);
  basis.modes = basis.modes.leftCols(count).eval();
  basis.inverse = basis.inverse.topRows(count).eval();
  basis.sd = basis.sd.head(count).eval();
  basis.lower = basis.lower.head(count).eval();
  basis.upper = basis.upper.head(count).eval();
  return basis;
}

/// No basis: every degree of freedom for itself, with its own spread.
pose::PoseBasis Unconnected(const pose::PoseBasis& basis) {
  pose::PoseBasis single;
  single.mean = basis.mean;
  single.modes = Eigen::MatrixXd::Identity(basis.dof(), basis.dof());
  single.inverse = single.modes;
  single.sd = (basis.modes * basis.sd.asDiagonal()).rowwise().norm().cwiseMax(1e-4);
  single.lower = -4 * single.sd;
  single.upper = 4 * single.sd;
  return single;
}

pose::GaussNewtonOptions SolverOptions(const Options& options) {
  pose::GaussNewtonOptions solver;
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
                     ? Resized(models.basis, parts->t_pose(2) / models.root_height_m)
                     : models.basis;
  const pose::PoseBasis full = parts->basis;
  if (options.mode == Mode::kPaper) parts->basis = Leading(parts->basis, kPaperShare);
  if (!options.use_basis) parts->basis = Unconnected(full);
  parts->subject = SubjectOf(body);
  parts->feet = StandingFeet(body);
  for (int side = 0; side < 2; ++side) {
    parts->fists[static_cast<std::size_t>(side)] = body::Fist(body, side);
  }
  parts->horizontal = models.horizontal;
  if (options.mode == Mode::kBest && options.use_basis && options.use_momentum &&
      !models.regression.empty()) {
    parts->regression = models.regression;
    parts->rest = Resized(models.rest, parts->t_pose(2) / models.root_height_m);
  }
  if (options.mode == Mode::kBest && models.rates && options.use_basis &&
      options.best.filter.on > 0) {
    parts->filter_basis = Leading(full, options.best.filter.share);
    parts->rates = models.rates;
    const Eigen::Index count = parts->filter_basis.size();
    parts->rates->first_sd = parts->rates->first_sd.head(count).eval();
    parts->rates->second_sd = parts->rates->second_sd.head(count).eval();
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
      fibonacci_(parts_->body, parts_->basis, SearchOptions(options)),
      legs_{Leg(parts_->body, parts_->feet[0], 0), Leg(parts_->body, parts_->feet[1], 1)},
      q_(parts_->t_pose),
      at_(parts_->body.skeleton) {
  if (!parts_->regression.empty()) {
    regressed_.emplace(parts_->body, parts_->rest, RegressedOptions(options));
    room_.resize(Features::kCount);
    likely_q_ = parts_->t_pose;
    likely_a_ = Eigen::VectorXd::Zero(parts_->rest.size());
  }
  if (parts_->rates) {
    pose::MotionFilterOptions filter;
    filter.frame_s = step_s_;
    filter.jerk = options.best.filter.jerk;
    filter.spread = options.best.filter.spread;
    filter_.emplace(parts_->body, parts_->filter_basis, *parts_->rates, filter);
  }
  const auto joints = static_cast<std::size_t>(parts_->body.skeleton.size());
  output_.q = q_;
  output_.R_WJ.resize(joints);
  output_.p_WJ_m.resize(joints);
  output_.joint_sd_m.assign(joints, kUnknownSdM);
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
  Tell(parts_->t_pose);
  std::fill(output_.joint_sd_m.begin(), output_.joint_sd_m.end(), kUnknownSdM);
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
  fibonacci_.Reset();
  if (regressed_) regressed_->Reset();
  was_regressed_ = false;
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
  if (filter_) {
    // In W the feet stand where the T-pose found them; here, about the origin.
    Eigen::VectorXd q = parts_->t_pose;
    body::ComputeKinematics(parts_->body.skeleton, q, at_);
    for (const FootGeometry& foot : parts_->feet) {
      const auto place = [&](const body::Point& point) {
        return at_.p_WJ[static_cast<std::size_t>(point.joint)];
      };
      q.head<2>() -= 0.25 * (place(foot.ankle) + place(foot.toe)).head<2>();
    }
    filter_->Start(q, kStartSd);
  }
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
  output_.resets = output_.momentum.resets + solver_resets_;
  output_.valid = output_.momentum.valid;
  Remember(inputs);
  TakeLagged();
  AdvanceFeatures();
  PlaceTargets();
  if (filter_) {
    Filter(inputs);
  } else {
    Solve();
  }
  return output_;
}

std::optional<Eigen::Vector2d> Reconstruction::PredictHorizontal(
    const momentum::ContactLoads& loads) {
  if (!horizontal_) return std::nullopt;
  return horizontal_->Advance(loads);
}

void Reconstruction::Remember(const Inputs& inputs) {
  Moment& now = past_[frames_ % kMostLag];
  now.hands = inputs.hands;
  for (HandInput& hand : now.hands) {
    hand.valid = hand.valid && hand.p_W_m.allFinite() && hand.sd_m.allFinite() &&
                 hand.sd_m.minCoeff() > 0 && (hand.p_W_m - origin_m_).norm() < kMostHandM;
  }
  now.momentum = output_.momentum;
  now.known = inputs.known;
  ++frames_;
}

void Reconstruction::TakeLagged() {
  const std::size_t back = std::min(frames_, static_cast<std::size_t>(lag_steps_) + 1);
  then_ = past_[(frames_ - back) % kMostLag];
  // The estimator tells places as they were, the rest as it is.
  then_.momentum.p_WC_m = output_.momentum.p_WC_m;
  then_.momentum.position_variance_m2 = output_.momentum.position_variance_m2;
}

void Reconstruction::AdvanceFeatures() {
  for (std::size_t side = 0; side < kHands; ++side) {
    if (then_.hands[side].valid) last_hands_m_[side] = then_.hands[side].p_W_m;
  }
  features_.Advance(last_hands_m_, then_.momentum);
}

void Reconstruction::PlaceTargets() {
  targets_.count = 0;
  targets_.has_com = targets_.has_angular = false;
  const bool paper = options_.mode == Mode::kPaper;
  for (std::size_t side = 0; side < kHands; ++side) {
    const HandInput& hand = then_.hands[side];
    if (!hand.valid) continue;
    const body::Point& fist = parts_->fists[side];
    pose::PointTarget target{fist.joint, fist.p_J_m, hand.p_W_m, hand.sd_m};
    if (paper) {
      target.sd_m.setConstant(kPaperHandSdM);
    } else {
      target.sd_m =
          (hand.sd_m.array().square() +
           std::pow(filter_ ? options_.best.filter.hand_sd_m : options_.best.hand_sd_m, 2))
              .sqrt();
    }
    targets_.Add(target);
  }
  AddFeet();
  AddMomentumTargets();
  for (int i = 0; i < targets_.count; ++i) {
    targets_.points[static_cast<std::size_t>(i)].p_W_m -= origin_m_;
  }
  targets_.com_W_m -= origin_m_;
}

void Reconstruction::AddFeet() {
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    const FootGeometry& geometry = parts_->feet[f];
    if (then_.known.feet) {
      const Known::Foot& foot = (*then_.known.feet)[f];
      targets_.Add({geometry.ankle.joint, geometry.ankle.p_J_m, foot.ankle_W_m,
                    Eigen::Vector3d::Constant(foot.ankle_sd_m)});
      targets_.Add({geometry.toe.joint, geometry.toe.p_J_m, foot.toe_W_m,
                    Eigen::Vector3d::Constant(foot.toe_sd_m)});
    } else if (options_.mode == Mode::kPaper) {
      AddPaperFootTargets(geometry, then_.momentum.feet[f], kPaperFootSdM, targets_);
    } else {
      const FilterConstants& filter = options_.best.filter;
      AddFootTargets(geometry, then_.momentum.feet[f], filter_ ? filter.foot : options_.best.foot,
                     targets_);
      if (filter_ && then_.momentum.feet[f].contact && targets_.count >= 2) {
        targets_.points[static_cast<std::size_t>(targets_.count - 2)].still_mps = filter.ankle_mps;
        targets_.points[static_cast<std::size_t>(targets_.count - 1)].still_mps = filter.still_mps;
      }
    }
  }
}

void Reconstruction::AddMomentumTargets() {
  const momentum::Estimate& told = then_.momentum;
  const Known& known = then_.known;
  const bool paper = options_.mode == Mode::kPaper;
  targets_.has_com = options_.use_momentum;
  targets_.com_W_m = told.p_WC_m;
  targets_.has_angular = options_.use_angular_momentum;
  // The solver's masses are the body's, which the cells have weighed anew.
  targets_.angular_W = told.angular_momentum_kgm2ps * (parts_->body.mass_kg / output_.mass_kg);
  if (paper) {
    targets_.com_sd_m << kPaperComSdM, kPaperComSdM, kPaperHeightSdM;
    targets_.angular_sd.setConstant(kPaperAngularSd);
  } else {
    targets_.com_sd_m =
        (told.position_variance_m2.array() + std::pow(options_.best.com_sd_m, 2)).sqrt();
    targets_.angular_sd =
        (told.angular_momentum_variance.array() + std::pow(options_.best.angular_sd, 2)).sqrt();
  }
  if (known.com_W_m) {
    targets_.com_W_m = *known.com_W_m;
    targets_.com_sd_m.setConstant(kKnownComSdM);
  }
  if (known.angular_W) {
    targets_.angular_W = *known.angular_W;
    targets_.angular_sd.setConstant(kKnownAngularSd);
  }
}

void Reconstruction::Solve() {
  const bool paper = options_.mode == Mode::kPaper;
  if (paper) {
    fibonacci_.Solve(targets_);
    q_ = fibonacci_.q();
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
  Tell(q_);
  if (!paper) TellSpreads();
}

/// The regression has seen both hands at all times.
bool Reconstruction::Regressed() const {
  return regressed_ && then_.hands[0].valid && then_.hands[1].valid;
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
    likely_q_.head<3>() = likely_q_.head<3>() * parts_->t_pose(2) + then_.momentum.p_WC_m -
                          origin_m_ - parts_->rest.mean.head<3>();
    likely_q_.tail(likely_q_.size() - 3) -= parts_->rest.mean.tail(likely_q_.size() - 3);
    likely_a_.noalias() = parts_->rest.inverse * likely_q_;
    solver.Solve(targets_, likely_a_);
  } else {
    solver.Solve(targets_);
  }
  q_ = solver.q();
}

void Reconstruction::Filter(const Inputs& inputs) {
  const FilterConstants& constants = options_.best.filter;
  pose::GroundLoad load;
  load.valid = options_.use_momentum && momentum::IsFinite(inputs.loads);
  for (const momentum::FootLoads& foot : inputs.loads.feet) {
    load.valid = load.valid && foot.valid;
    for (std::size_t i = 0; i < foot.count; ++i) {
      // The solver's masses are the body's, which the cells have weighed anew.
      const double force_n = foot.cells[i].load_n * parts_->body.mass_kg / output_.mass_kg;
      const Eigen::Vector3d p_m = foot.cells[i].p_WS_m - origin_m_;
      load.force_n += force_n;
      load.moment_nm += force_n * Eigen::Vector2d(p_m.y(), -p_m.x());
    }
  }
  load.force_sd_n = constants.force_sd_n;
  load.moment_sd_nm = constants.moment_sd_nm;
  if (!inputs.known.com_W_m) {
    targets_.com_sd_m.head<2>() *= constants.com_doubt;
    targets_.com_sd_m.z() *= constants.height_doubt;
  }
  filter_->Advance(targets_, load);
  q_ = filter_->q();
  if (options_.clean_up && constants.clean_up > 0) CleanUp();
  q_.head<3>() += origin_m_;
  Tell(q_);
  for (int i = 0; i < kSpreadsAFrame; ++i) {
    next_spread_ = (next_spread_ + 1) % output_.joint_sd_m.size();
    output_.joint_sd_m[next_spread_] = filter_->JointSd(static_cast<int>(next_spread_));
  }
}

void Reconstruction::CleanUp() {
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    if (then_.momentum.feet[f].contact || then_.known.feet || options_.mode == Mode::kPaper) {
      legs_[f].Solve(targets_, kCleanUpIterations, q_);
    }
  }
}

void Reconstruction::Tell(const Eigen::VectorXd& q) {
  output_.q = q;
  body::ComputeKinematics(parts_->body.skeleton, output_.q, at_);
  std::copy(at_.R_WJ.begin(), at_.R_WJ.end(), output_.R_WJ.begin());
  std::copy(at_.p_WJ.begin(), at_.p_WJ.end(), output_.p_WJ_m.begin());
}

void Reconstruction::TellSpreads() {
  for (int i = 0; i < kSpreadsAFrame; ++i) {
    next_spread_ = (next_spread_ + 1) % output_.joint_sd_m.size();
    pose::GaussNewton& solver = was_regressed_ ? *regressed_ : gauss_newton_;
    output_.joint_sd_m[next_spread_] = solver.JointSd(static_cast<int>(next_spread_));
  }
}

}  // namespace footing::reconstruction
