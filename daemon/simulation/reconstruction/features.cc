#include "daemon/simulation/reconstruction/features.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::reconstruction {
namespace {

constexpr double kHandS = 0.03, kSlowHandS = 0.1;  // Smoothing of the hands, and for their speed.
constexpr std::array<double, Features::kHistories> kHistoriesS{0.1, 0.3, 1.0};
constexpr double kMostAcceleration = 15, kMostAngular = 20, kMostTorque = 60;
constexpr double kMostAirS = 0.6;
constexpr double kLeastLoadShare = 0.1;  // Below, the centre of pressure is taken to be under C.
constexpr double kMostScaled = 4;

/// Appends to a vector of fixed size.
template <typename Vector>
struct Appender {
  Vector& values;
  Eigen::Index at = 0;

  template <typename Derived>
  void Add(const Eigen::MatrixBase<Derived>& part) {
    values.segment(at, part.size()) = part;
    at += part.size();
  }
  void Add(double value) { values(at++) = value; }
};

Eigen::Vector3d Clipped(const Eigen::Vector3d& value, double most) {
  return value.cwiseMax(-most).cwiseMin(most);
}

}  // namespace

const Features::Values& Features::Advance(const std::array<Eigen::Vector3d, 2>& hands_W_m,
                                          const momentum::Estimate& estimate) {
  const double unit = 1 / root_height_m_;
  const double weight_n = mass_kg_ * kStandardGravityMps2;
  Eigen::Matrix<double, 6, 1> hands;
  hands << hands_W_m[0], hands_W_m[1];
  if (!started_) hands_ = slow_hands_ = hands;
  hands_ += (1 - std::exp(-step_s_ / kHandS)) * (hands - hands_);
  slow_hands_ += (1 - std::exp(-step_s_ / kSlowHandS)) * (hands - slow_hands_);

  const Eigen::Vector3d& c = estimate.p_WC_m;
  std::array<double, 2> share{};
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  for (std::size_t f = 0; f < 2; ++f) {
    const momentum::FootEstimate& foot = estimate.feet[f];
    share[f] = std::clamp(foot.load_n / weight_n, -0.2, 4.0);
    const Eigen::Vector3d& p = foot.cop_valid ? foot.p_WP_m : foot.p_WF_m;
    moment += std::max(share[f], 0.0) * p.head<2>();
  }
  const double total = std::max(share[0], 0.0) + std::max(share[1], 0.0);
  const Eigen::Vector2d cop =
      total > kLeastLoadShare ? Eigen::Vector2d(moment / total) : Eigen::Vector2d(c.head<2>());

  Changing changing;
  Appender<Changing> change{changing};
  change.Add(unit * hands_);
  change.Add(unit * cop);
  change.Add(Eigen::Vector2d(share[0], share[1]));
  for (const momentum::FootEstimate& foot : estimate.feet) change.Add(unit * foot.p_WF_m.head<2>());
  change.Add(unit * c);

  Eigen::Matrix<double, kShape, 1> shape;
  shape << unit * (hands_.head<3>() - c), unit * (hands_.tail<3>() - c), unit * c.z();

  Appender<Values> out{values_};
  out.Add(shape);
  out.Add(unit / kSlowHandS * (hands_ - slow_hands_));
  out.Add(unit * estimate.v_WC_mps);
  out.Add(Clipped(estimate.a_WC_mps2, kMostAcceleration));
  out.Add(Clipped(estimate.angular_momentum_kgm2ps, kMostAngular) / mass_kg_);
  out.Add(Clipped(estimate.angular_momentum_rate_nm, kMostTorque) / mass_kg_);
  for (const momentum::FootEstimate& foot : estimate.feet) {
    out.Add(unit * (foot.p_WF_m - c).head<2>());
    out.Add(foot.contact ? 1.0 : 0.0);
    out.Add(std::min(foot.airborne_s, kMostAirS));
  }
  out.Add(unit * (cop - c.head<2>()));
  out.Add(Eigen::Vector2d(share[0], share[1]));
  for (std::size_t i = 0; i < kHistories; ++i) {
    if (!started_) slow_[i] = changing;
    slow_[i] += (1 - std::exp(-step_s_ / kHistoriesS[i])) * (changing - slow_[i]);
    out.Add(changing - slow_[i]);
  }
  for (int i = 0; i < kShape; ++i) {
    for (int k = i; k < kShape; ++k) out.Add(shape(i) * shape(k));
  }
  started_ = true;
  return values_;
}

momentum::Estimate WithoutLoads(const momentum::Estimate& estimate, double com_height_m) {
  momentum::Estimate bare;
  bare.time_s = estimate.time_s;
  bare.valid = estimate.valid;
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    const momentum::FootEstimate& foot = estimate.feet[f];
    momentum::FootEstimate& shown = bare.feet[f];
    shown.contact = foot.contact;
    shown.valid = foot.valid;
    shown.p_WF_m = foot.p_WF_m;
    shown.airborne_s = foot.airborne_s;
    bare.p_WC_m += foot.p_WF_m / double{momentum::kFeet};
  }
  bare.p_WC_m.z() = com_height_m;
  return bare;
}

StripMatrix::StripMatrix(const Eigen::MatrixXf& dense) : rows_(dense.rows()), cols_(dense.cols()) {
  strips_.setZero(kStrip, StripRows() / kStrip * cols_);
  if (dense.size() == 0) return;
  for (Eigen::Index row = 0; row < rows_; ++row) {
    strips_.row(row % kStrip).segment(row / kStrip * cols_, cols_) = dense.row(row);
  }
}

Eigen::MatrixXf StripMatrix::Dense() const {
  Eigen::MatrixXf dense(rows_, cols_);
  if (dense.size() == 0) return dense;
  for (Eigen::Index row = 0; row < rows_; ++row) {
    dense.row(row) = strips_.row(row % kStrip).segment(row / kStrip * cols_, cols_);
  }
  return dense;
}

void StripMatrix::AddProduct(const Eigen::VectorXf& x, Eigen::VectorXf& y) const {
  using Strip = Eigen::Array<float, kStrip, 1>;
  const float* column = strips_.data();
  for (Eigen::Index row = 0; row < StripRows(); row += kStrip) {
    Strip sum = Eigen::Map<const Strip>(y.data() + row);
    for (Eigen::Index i = 0; i < cols_; ++i, column += kStrip) {
      sum += x(i) * Eigen::Map<const Strip, Eigen::Aligned16>(column);
    }
    Eigen::Map<Strip>(y.data() + row) = sum;
  }
}

PoseRegression::Workspace PoseRegression::MakeWorkspace() const {
  return {Eigen::VectorXd::Zero(mean.size()), Eigen::VectorXf::Zero(mean.size()),
          Eigen::VectorXf::Zero(waves.StripRows()),
          Eigen::VectorXf::Zero(wave_weights.StripRows())};
}

void PoseRegression::Predict(const Features::Values& features, Workspace& workspace,
                             Eigen::VectorXd& q) const {
  workspace.scaled =
      (features - mean).cwiseProduct(scale).cwiseMax(-kMostScaled).cwiseMin(kMostScaled);
  q = offset;
  q.noalias() += weights * workspace.scaled;
  if (phases.size() == 0) return;
  workspace.single = workspace.scaled.cast<float>();
  workspace.waved.head(phases.size()) = phases;
  waves.AddProduct(workspace.single, workspace.waved);
  workspace.waved = workspace.waved.array().cos();
  workspace.part.setZero();
  wave_weights.AddProduct(workspace.waved, workspace.part);
  q += workspace.part.head(q.size()).cast<double>();
}

}  // namespace footing::reconstruction
