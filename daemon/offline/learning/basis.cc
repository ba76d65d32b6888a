#include "daemon/offline/learning/basis.h"

#include <Eigen/Eigenvalues>

#include "common/base/result.h"
#include "daemon/offline/learning/scaling.h"

namespace footing::learning {
namespace {

constexpr double kRadiansOfMetre = 2.5;

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
                  .variances = {}};
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
}

}  // namespace footing::learning
