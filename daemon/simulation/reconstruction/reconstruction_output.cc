#include <algorithm>
#include <cmath>

#include "common/body/momentum.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

/// What is told of a solved pose.
namespace footing::reconstruction {
namespace {

constexpr int kSpreadsAFrame = 2;  // Of the joints and C, those whose covariance is told anew.
// Frames of the CMU clips 13_29, 13_30 and 13_31 have a misfit of 0.4, one in 60 has more than 2; a
// walk on boards (walk_03) has 2.3. Of more than 1.5 poses are further off than they tell.
constexpr double kFitTimeS = 0.5, kMostAtOnce = 25;
constexpr double kUsualMisfit = 1.5, kMostMisfit = 2;

}  // namespace

void Reconstruction::Tell(const Eigen::VectorXd& q) {
  output_.q = q;
  std::copy(at_.R_WJ.begin(), at_.R_WJ.end(), output_.R_WJ.begin());
  std::copy(at_.p_WJ.begin(), at_.p_WJ.end(), output_.p_WJ_m.begin());
}

void Reconstruction::TellSpreads() {
  pose::GaussNewton& solver = was_regressed_ ? *regressed_ : gauss_newton_;
  for (int i = 0; i < kSpreadsAFrame; ++i) {
    next_spread_ = (next_spread_ + 1) % (linear_sd_m_.size() + 1);
    if (next_spread_ == linear_sd_m_.size()) {
      com_height_sd_m_ = options_.best.com_spread * solver.ComSd().z();
    } else {
      linear_sd_m_[next_spread_] =
          options_.best.spread * solver.JointSd(static_cast<int>(next_spread_));
    }
  }
  const double doubt = Doubt();
  std::transform(linear_sd_m_.begin(), linear_sd_m_.end(), output_.joint_sd_m.begin(),
                 [doubt](double sd_m) { return doubt * sd_m; });
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    const momentum::FootEstimate& foot = then_.momentum.feet[f];
    if (foot.contact || then_.known.feet) continue;
    const double aloft_m =
        options_.best.aloft_sd_m * (1 - std::exp(-foot.airborne_s / options_.best.aloft_time_s));
    for (const std::size_t joint : parts_->shanks[f]) {
      output_.joint_sd_m[joint] = std::hypot(output_.joint_sd_m[joint], aloft_m);
    }
  }
}

void Reconstruction::TellFit() {
  double sum = 0;
  int rows = 0;
  const auto add = [&](const Eigen::Vector3d& off_m, const Eigen::Vector3d& sd_m) {
    sum += off_m.cwiseQuotient(sd_m).squaredNorm();
    rows += 3;
  };
  for (int i = 0; i < targets_.count; ++i) {
    const pose::PointTarget& point = targets_.points[static_cast<std::size_t>(i)];
    Eigen::Vector3d off_m = point.p_W_m - PlaceOf(point, at_);
    if (point.from_joint < 0) off_m += origin_m_;
    add(off_m, point.sd_m);
  }
  if (targets_.has_com) {
    add(targets_.com_W_m + origin_m_ - body::CentreOfMass(parts_->body, at_), targets_.com_sd_m);
  }
  const BestConstants& best = options_.best;
  const double weight = was_regressed_ ? best.regressed_prior_weight : best.prior_weight;
  const pose::PoseBasis& basis = was_regressed_ ? parts_->rest : parts_->basis;
  const Eigen::VectorXd& likely_q = was_regressed_ ? likely_q_ : basis.mean;
  const Eigen::VectorXd& q = was_regressed_ ? regressed_->q() : gauss_newton_.q();
  for (int i = 0; i < basis.size(); ++i) {
    sum += std::pow(weight * basis.inverse.row(i).dot(q - likely_q) / basis.sd(i), 2);
  }
  const double now = std::min(sum / std::max(rows, 1), kMostAtOnce);
  if (frames_ <= 1) output_.misfit = 0;
  if (std::isfinite(now)) {
    output_.misfit += (1 - std::exp(-step_s_ / kFitTimeS)) * (now - output_.misfit);
  }
  output_.valid = output_.valid && output_.misfit < kMostMisfit;
}

/// How many times a deviation is to be told as it follows from the terms: errors of a model that
/// does not hold grow faster than what is left of its terms.
double Reconstruction::Doubt() const {
  return std::pow(std::max(1.0, output_.misfit / kUsualMisfit), 2);
}

void Reconstruction::TellCom() {
  output_.com_W_m = then_.momentum.p_WC_m;
  output_.com_variance_m2 = then_.momentum.position_variance_m2;
  if (options_.mode != Mode::kBest || !targets_.has_com) return;
  output_.com_W_m.z() = body::CentreOfMass(parts_->body, at_).z();
  output_.com_variance_m2.z() = com_height_sd_m_ * com_height_sd_m_;
  output_.com_variance_m2 *= Doubt() * Doubt();
}

}  // namespace footing::reconstruction
