#include "daemon/simulation/pose/motion_filter.h"

#include <unsupported/Eigen/MatrixFunctions>

#include <algorithm>
#include <cmath>

#include "common/result/result.h"
#include "common/units/units.h"

namespace footing::pose {
namespace {

constexpr Eigen::Index kMostPlaceRows = 3 * kMaxPoints + 3;
constexpr Eigen::Index kMostStillRows = 3 * kMaxPoints;
constexpr Eigen::Index kLoadRows = 3;
constexpr double kLeastRate = 1e-3;  // Of a coefficient that hardly ever changes, of its spread.

/// Transition and noise over a step of x''' + c2 x'' + c1 x' + c0 x = w whose stationary variances
/// are those of x, x', x'' (van Loan 1978).
void Discretise(double sd, double first_sd, double second_sd, double jerk, double step_s,
                Eigen::Matrix3d& transition, Eigen::Matrix3d& noise) {
  const double p0 = sd * sd, p1 = first_sd * first_sd;
  // A second derivative is at least as large as that of a single frequency.
  const double p2 = std::max(second_sd * second_sd, 1.2 * p1 * p1 / p0);
  const double c1 = p2 / p1, c2 = jerk * std::sqrt(p2 / p1), c0 = c2 * p1 / p0;
  const double w = 2 * c2 * (p2 - p1 * p1 / p0);
  Eigen::Matrix3d a;
  a << 0, 1, 0, 0, 0, 1, -c0, -c1, -c2;
  Eigen::Matrix<double, 6, 6> both = Eigen::Matrix<double, 6, 6>::Zero();
  both.topLeftCorner<3, 3>() = -a * step_s;
  both(2, 5) = w * step_s;
  both.bottomRightCorner<3, 3>() = a.transpose() * step_s;
  const Eigen::Matrix<double, 6, 6> e = both.exp();
  transition = e.bottomRightCorner<3, 3>().transpose();
  noise = transition * e.topRightCorner<3, 3>();
  noise = (0.5 * (noise + noise.transpose())).eval();
}

}  // namespace

MotionFilter::MotionFilter(const body::Body& body, const PoseBasis& basis, const BasisRates& rates,
                           const MotionFilterOptions& options)
    : body_(&body),
      basis_(&basis),
      options_(options),
      k_(basis.size()),
      transition_(k_, 9),
      noise_(k_, 9),
      x_(Eigen::VectorXd::Zero(3 * k_)),
      x_predicted_(x_),
      x_off_(x_),
      p_(Eigen::MatrixXd::Zero(3 * k_, 3 * k_)),
      p_half_(p_),
      q_(basis.mean),
      q_dot_(Eigen::VectorXd::Zero(basis.dof())),
      q_ddot_(q_dot_),
      at_(body.skeleton),
      velocities_(body.skeleton),
      accelerations_(body.skeleton),
      room_(body.skeleton),
      centroidal_(6, basis.dof()),
      jacobian_(3, basis.dof()),
      com_jacobian_(3, k_),
      angular_jacobian_(3, k_),
      place_rows_(kMostPlaceRows, k_),
      still_rows_(kMostStillRows, k_),
      load_rows_(kLoadRows, k_),
      load_acceleration_rows_(kLoadRows, k_),
      place_residuals_(kMostPlaceRows),
      still_residuals_(kMostStillRows),
      load_residuals_(kLoadRows),
      residuals_(kMostPlaceRows + kMostStillRows + kLoadRows),
      cross_(3 * k_, kMostPlaceRows + kMostStillRows + kLoadRows),
      whitened_(kMostPlaceRows + kMostStillRows + kLoadRows, 3 * k_),
      innovation_(residuals_.size(), residuals_.size()),
      joint_room_(3, k_),
      joint_cross_(3, k_) {
  FOOTING_CHECK(body.skeleton.dof == basis.dof() && rates.first_sd.size() == k_ &&
                rates.second_sd.size() == k_);
  MakeTransition(rates);
}

void MotionFilter::MakeTransition(const BasisRates& rates) {
  for (Eigen::Index i = 0; i < k_; ++i) {
    const double sd = options_.spread * basis_->sd(i);
    const double first = std::max(options_.spread * rates.first_sd(i), kLeastRate * sd);
    Eigen::Matrix3d transition, noise;
    Discretise(sd, first, options_.spread * rates.second_sd(i), options_.jerk, options_.frame_s,
               transition, noise);
    for (Eigen::Index r = 0; r < 3; ++r) {
      for (Eigen::Index c = 0; c < 3; ++c) {
        transition_(i, 3 * r + c) = transition(r, c);
        noise_(i, 3 * r + c) = noise(r, c);
      }
    }
  }
}

void MotionFilter::Start(const Eigen::VectorXd& q, double sd) {
  x_.setZero();
  x_.head(k_).noalias() = basis_->inverse * (q - basis_->mean);
  p_.setZero();
  for (Eigen::Index i = 0; i < k_; ++i) {
    const double spread = std::min(sd, basis_->sd(i));
    p_(i, i) = spread * spread;
    p_(k_ + i, k_ + i) = p_(2 * k_ + i, 2 * k_ + i) = 1e-4 * spread * spread;
  }
  started_ = true;
  Place();
}

void MotionFilter::Predict() {
  const auto block = [this](Eigen::MatrixXd& m, Eigen::Index r, Eigen::Index c) {
    return m.block(r * k_, c * k_, k_, k_);
  };
  for (Eigen::Index r = 0; r < 3; ++r) {
    x_off_.segment(r * k_, k_) = transition_.col(3 * r).cwiseProduct(x_.head(k_)) +
                                 transition_.col(3 * r + 1).cwiseProduct(x_.segment(k_, k_)) +
                                 transition_.col(3 * r + 2).cwiseProduct(x_.tail(k_));
    for (Eigen::Index c = 0; c < 3; ++c) {
      block(p_half_, r, c) = transition_.col(3 * r).asDiagonal() * block(p_, 0, c);
      block(p_half_, r, c) += transition_.col(3 * r + 1).asDiagonal() * block(p_, 1, c);
      block(p_half_, r, c) += transition_.col(3 * r + 2).asDiagonal() * block(p_, 2, c);
    }
  }
  x_ = x_off_;
  for (Eigen::Index r = 0; r < 3; ++r) {
    for (Eigen::Index c = 0; c < 3; ++c) {
      block(p_, r, c) = block(p_half_, r, 0) * transition_.col(3 * c).asDiagonal();
      block(p_, r, c) += block(p_half_, r, 1) * transition_.col(3 * c + 1).asDiagonal();
      block(p_, r, c) += block(p_half_, r, 2) * transition_.col(3 * c + 2).asDiagonal();
      block(p_, r, c).diagonal() += noise_.col(3 * r + c);
    }
  }
}

/// Pose, velocities and accelerations of x_.
void MotionFilter::Place() {
  q_ = basis_->mean;
  q_.noalias() += basis_->modes * x_.head(k_);
  q_dot_.noalias() = basis_->modes * x_.segment(k_, k_);
  q_ddot_.noalias() = basis_->modes * x_.tail(k_);
  body::ComputeKinematics(body_->skeleton, q_, at_);
  body::ComputeVelocities(body_->skeleton, at_, q_dot_, velocities_);
  momentum_ = body::ComputeMomentum(*body_, at_, velocities_);
}

void MotionFilter::AddPoint(const PointTarget& point) {
  const auto joint = static_cast<std::size_t>(point.joint);
  const Eigen::Vector3d arm_W_m = at_.R_WJ[joint] * point.p_J_m;
  const Eigen::Vector3d p_W_m = at_.p_WJ[joint] + arm_W_m;
  const Eigen::Vector3d weight = point.sd_m.cwiseInverse();
  body::PointJacobian(body_->skeleton, at_, point.joint, p_W_m, jacobian_);
  if (point.still_mps > 0) {
    // Before the rows are weighed for the place.
    const double still = 1 / point.still_mps;
    still_rows_.middleRows<3>(stills_).noalias() = jacobian_ * basis_->modes;
    place_rows_.middleRows<3>(places_) = weight.asDiagonal() * still_rows_.middleRows<3>(stills_);
    still_rows_.middleRows<3>(stills_) *= still;
    still_residuals_.segment<3>(stills_) =
        -still * (velocities_.v_WJ[joint] + velocities_.w_WJ[joint].cross(arm_W_m));
    stills_ += 3;
  } else {
    jacobian_ = weight.asDiagonal() * jacobian_;
    place_rows_.middleRows<3>(places_).noalias() = jacobian_ * basis_->modes;
  }
  place_residuals_.segment<3>(places_) = weight.cwiseProduct(point.p_W_m - p_W_m);
  places_ += 3;
}

void MotionFilter::AddLoad(const GroundLoad& load) {
  body::ComputeAccelerations(body_->skeleton, at_, q_dot_, q_ddot_, velocities_, accelerations_);
  const body::MomentumRate rate =
      body::ComputeMomentumRate(*body_, at_, velocities_, accelerations_);
  const Eigen::Vector3d& c = momentum_.p_WC;
  const double m = body_->mass_kg;
  angular_jacobian_.noalias() = centroidal_.bottomRows<3>() * basis_->modes;
  const Eigen::Vector3d f = rate.linear_W + Eigen::Vector3d(0, 0, m * kStandardGravityMps2);
  const Eigen::Vector3d moment = c.cross(f) + rate.angular_W;
  const double force = 1 / load.force_sd_n, turn = 1 / load.moment_sd_nm;
  load_rows_.row(0).setZero();
  load_acceleration_rows_.row(0) = force * com_jacobian_.row(2);
  load_residuals_(0) = force * (load.force_n - f.z());
  // M_x = c_y F_z - c_z F_y + L'_x,  M_y = c_z F_x - c_x F_z + L'_y.
  load_rows_.row(1) = turn / m * (f.z() * com_jacobian_.row(1) - f.y() * com_jacobian_.row(2));
  load_acceleration_rows_.row(1) = turn * (c.y() * com_jacobian_.row(2) -
                                           c.z() * com_jacobian_.row(1) + angular_jacobian_.row(0));
  load_residuals_(1) = turn * (load.moment_nm.x() - moment.x());
  load_rows_.row(2) = turn / m * (f.x() * com_jacobian_.row(2) - f.z() * com_jacobian_.row(0));
  load_acceleration_rows_.row(2) = turn * (c.z() * com_jacobian_.row(0) -
                                           c.x() * com_jacobian_.row(2) + angular_jacobian_.row(1));
  load_residuals_(2) = turn * (load.moment_nm.y() - moment.y());
  loads_ = kLoadRows;
}

void MotionFilter::Linearise(const PoseTargets& targets, const GroundLoad& load) {
  places_ = stills_ = loads_ = 0;
  for (int i = 0; i < targets.count; ++i) AddPoint(targets.points[static_cast<std::size_t>(i)]);
  if (!targets.has_com && !load.valid) return;
  body::ComputeCentroidalMatrix(*body_, at_, room_, centroidal_);
  com_jacobian_.noalias() = centroidal_.topRows<3>() * basis_->modes;  // Times the mass.
  if (targets.has_com) {
    const Eigen::Vector3d weight = targets.com_sd_m.cwiseInverse();
    place_rows_.middleRows<3>(places_) = (weight / body_->mass_kg).asDiagonal() * com_jacobian_;
    place_residuals_.segment<3>(places_) = weight.cwiseProduct(targets.com_W_m - momentum_.p_WC);
    places_ += 3;
  }
  if (load.valid) AddLoad(load);
}

/// P H' into cross_, the innovation's covariance factorised; rows are weighed, so R is 1.
void MotionFilter::Gain() {
  const Eigen::Index n = places_ + stills_ + loads_;
  const auto place = place_rows_.topRows(places_);
  const auto still = still_rows_.topRows(stills_);
  const auto load = load_rows_.topRows(loads_);
  const auto load_acceleration = load_acceleration_rows_.topRows(loads_);
  auto cross = cross_.leftCols(n);
  cross.leftCols(places_).noalias() = p_.leftCols(k_) * place.transpose();
  cross.middleCols(places_, stills_).noalias() = p_.middleCols(k_, k_) * still.transpose();
  cross.rightCols(loads_).noalias() = p_.leftCols(k_) * load.transpose();
  cross.rightCols(loads_).noalias() += p_.rightCols(k_) * load_acceleration.transpose();
  auto s = innovation_.topLeftCorner(n, n);
  s.topRows(places_).noalias() = place * cross.topRows(k_);
  s.middleRows(places_, stills_).noalias() = still * cross.middleRows(k_, k_);
  s.bottomRows(loads_).noalias() = load * cross.topRows(k_);
  s.bottomRows(loads_).noalias() += load_acceleration * cross.bottomRows(k_);
  s.diagonal().array() += 1;
  residuals_.head(places_) = place_residuals_.head(places_);
  residuals_.segment(places_, stills_) = still_residuals_.head(stills_);
  residuals_.segment(places_ + stills_, loads_) = load_residuals_.head(loads_);
}

void MotionFilter::Advance(const PoseTargets& targets, const GroundLoad& load) {
  FOOTING_CHECK(started_);
  Predict();
  x_predicted_ = x_;
  Eigen::Index n = 0;
  for (int iteration = 0; iteration < options_.iterations; ++iteration) {
    Place();
    Linearise(targets, load);
    n = places_ + stills_ + loads_;
    if (n == 0) return;
    Gain();
    // z - h(x) + H (x - predicted).
    x_off_ = x_ - x_predicted_;
    residuals_.head(places_).noalias() += place_rows_.topRows(places_) * x_off_.head(k_);
    residuals_.segment(places_, stills_).noalias() +=
        still_rows_.topRows(stills_) * x_off_.segment(k_, k_);
    residuals_.segment(places_ + stills_, loads_).noalias() +=
        load_rows_.topRows(loads_) * x_off_.head(k_);
    residuals_.segment(places_ + stills_, loads_).noalias() +=
        load_acceleration_rows_.topRows(loads_) * x_off_.tail(k_);
    // In place: the lower triangle of innovation_ becomes its factor.
    Eigen::Ref<Eigen::MatrixXd> square = innovation_.topLeftCorner(n, n);
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(square);
    auto weights = residuals_.head(n);
    factor.matrixL().solveInPlace(weights);
    factor.matrixU().solveInPlace(weights);
    x_ = x_predicted_;
    x_.noalias() += cross_.leftCols(n) * weights;
  }
  auto whitened = whitened_.topRows(n);
  whitened = cross_.leftCols(n).transpose();
  innovation_.topLeftCorner(n, n).triangularView<Eigen::Lower>().solveInPlace(whitened);
  p_.selfadjointView<Eigen::Lower>().rankUpdate(whitened.transpose(), -1);
  p_.triangularView<Eigen::StrictlyUpper>() = p_.transpose();
  Place();
}

double MotionFilter::JointSd(int joint) {
  const auto index = static_cast<std::size_t>(joint);
  body::PointJacobian(body_->skeleton, at_, joint, at_.p_WJ[index], jacobian_);
  joint_room_.noalias() = jacobian_ * basis_->modes;
  joint_cross_.noalias() = joint_room_ * p_.topLeftCorner(k_, k_);
  const double sum = joint_room_.cwiseProduct(joint_cross_).sum();
  return std::sqrt(std::max(sum, 0.0) / 3);
}

}  // namespace footing::pose
