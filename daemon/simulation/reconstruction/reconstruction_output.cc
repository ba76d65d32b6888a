#include <algorithm>
#include <cmath>

#include "common/body/momentum.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

/// What is told of a solved pose.
namespace footing::reconstruction {
namespace {

constexpr int kSpreadsAFrame = 2;  // Of the joints and C, those whose covariance is told anew.

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
  std::copy(linear_sd_m_.begin(), linear_sd_m_.end(), output_.joint_sd_m.begin());
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    const momentum::FootEstimate& foot = then_.momentum.feet[f];
    if (foot.contact || then_.known.feet) continue;
    const double aloft_m =
        options_.best.aloft_sd_m * (1 - std::exp(-foot.airborne_s / options_.best.aloft_time_s));
    for (const std::size_t joint : parts_->shanks[f]) {
      output_.joint_sd_m[joint] = std::hypot(linear_sd_m_[joint], aloft_m);
    }
  }
}

void Reconstruction::TellCom() {
  output_.com_W_m = then_.momentum.p_WC_m;
  output_.com_variance_m2 = then_.momentum.position_variance_m2;
  if (options_.mode != Mode::kBest || !targets_.has_com) return;
  output_.com_W_m.z() = body::CentreOfMass(parts_->body, at_).z();
  output_.com_variance_m2.z() = com_height_sd_m_ * com_height_sd_m_;
}

}  // namespace footing::reconstruction
