#include "daemon/offline/training/basis.h"

#include <Eigen/Eigenvalues>

#include "common/motion/edit.h"
#include "common/result/result.h"
#include "daemon/offline/training/scaling.h"

namespace footing::training {
namespace {

constexpr double kRadiansOfMetre = 2.5;
constexpr double kSmoothHz = 6;

}  // namespace

int PoseBasis::ComponentsFor(double fraction) const {
  double sum = 0;
  const double enough = fraction * variances.sum();
  for (int k = 0; k < variances.size(); ++k) {
    sum += variances(k);
    if (sum >= enough) return k + 1;
  }
  return static_cast<int>(variances.size());
}

PoseBasis MakeBasis(const Eigen::MatrixXd& poses, std::vector<std::string> dofs) {
  FOOTING_CHECK(poses.cols() > 0 && poses.rows() == static_cast<Eigen::Index>(dofs.size()));
  PoseBasis basis{.dofs = std::move(dofs),
                  .mean = poses.rowwise().mean(),
                  .scale = Eigen::VectorXd::Ones(poses.rows()),
                  .components = {},
                  .variances = {},
                  .first_sd = {},
                  .second_sd = {}};
  basis.scale.head(3).setConstant(kRadiansOfMetre);  // The root's position.
  const Eigen::MatrixXd scaled =
      ((poses.colwise() - basis.mean).array().colwise() * basis.scale.array()).matrix();
  const Eigen::MatrixXd covariance =
      scaled * scaled.transpose() / static_cast<double>(poses.cols());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  FOOTING_CHECK(solver.info() == Eigen::Success);
  basis.variances = solver.eigenvalues().reverse().cwiseMax(0);
  basis.components = solver.eigenvectors().rowwise().reverse().transpose();
  for (Eigen::Index k = 0; k < basis.components.rows(); ++k) {
    Eigen::Index greatest = 0;
    basis.components.row(k).cwiseAbs().maxCoeff(&greatest);
    if (basis.components(k, greatest) < 0) basis.components.row(k) *= -1;
  }
  return basis;
}

void AddRates(const std::vector<const motion::Motion*>& motions, PoseBasis& basis) {
  const Eigen::MatrixXd inverse = basis.components * basis.scale.asDiagonal();
  Eigen::VectorXd first = Eigen::VectorXd::Zero(basis.mean.size()), second = first;
  double frames = 0;
  for (const motion::Motion* motion : motions) {
    const motion::MotionRates rates = motion::Rates(motion::Smoothed(*motion, kSmoothHz));
    // Frames count by the time that they stand for.
    const double weight = 1 / motion->rate_hz;
    first += weight * (inverse * rates.q_dot).rowwise().squaredNorm();
    second += weight * (inverse * rates.q_ddot).rowwise().squaredNorm();
    frames += weight * static_cast<double>(motion->frames());
  }
  FOOTING_CHECK(frames > 0);
  basis.first_sd = (first / frames).cwiseSqrt();
  basis.second_sd = (second / frames).cwiseSqrt();
}

void AppendTensors(const PoseBasis& basis, model::Model& model) {
  const auto dof = static_cast<std::uint32_t>(basis.mean.size());
  const auto add = [&](const char* name, std::vector<std::uint32_t> shape,
                       const Eigen::MatrixXd& values, std::vector<std::string> labels) {
    model.tensors.push_back({.name = name,
                             .shape = std::move(shape),
                             .values = ToFloats(values),
                             .labels = std::move(labels)});
  };
  add("mean", {dof}, basis.mean, basis.dofs);
  add("scale", {dof}, basis.scale, basis.dofs);
  add("components", {dof, dof}, basis.components.transpose(), basis.dofs);
  add("variances", {dof}, basis.variances, {});
  if (basis.first_sd.size() == 0) return;
  add("first_sd", {dof}, basis.first_sd, {});
  add("second_sd", {dof}, basis.second_sd, {});
}

}  // namespace footing::training
