#include "daemon/simulation/reconstruction/models.h"

#include <algorithm>
#include <cmath>

#include "daemon/simulation/cascade/model.h"
#include "daemon/simulation/momentum/horizontal_network.h"

namespace footing::reconstruction {
namespace {

/// Coefficients go so far, in standard deviations, in the paper's search.
constexpr double kReach = 4;
/// Below, a component is a degree of freedom that nobody moved: m or rad.
constexpr double kLeastSd = 1e-5;

Result<Eigen::MatrixXd> Matrix(const model::Model& model, const std::string& name,
                               std::uint32_t rows, std::uint32_t columns,
                               const std::string& origin) {
  const std::vector<std::uint32_t> shape =
      columns == 1 ? std::vector<std::uint32_t>{rows} : std::vector<std::uint32_t>{rows, columns};
  const auto tensor = model::Find(model, name, shape, origin);
  if (!tensor) return tensor.error();
  Eigen::MatrixXd matrix(rows, columns);
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index k = 0; k < matrix.cols(); ++k) {
      matrix(i, k) = (*tensor)->values[static_cast<std::size_t>(i * matrix.cols() + k)];
    }
  }
  return matrix;
}

Result<void> ReadBasis(const NamedModel& named, Models& models) {
  const model::Tensor* mean = model::FindAny(named.model, "mean");
  if (mean == nullptr || mean->shape.size() != 1 || mean->labels.size() != mean->values.size()) {
    return InvalidData(named.origin + ": its tensor mean does not name the degrees of freedom");
  }
  const std::uint32_t dof = mean->shape[0];
  const auto read = [&](const char* name, std::uint32_t rows, std::uint32_t columns) {
    return Matrix(named.model, name, rows, columns, named.origin);
  };
  const auto scale = read("scale", dof, 1);
  if (!scale) return scale.error();
  const auto components = read("components", dof, dof);
  if (!components) return components.error();
  const auto variances = read("variances", dof, 1);
  if (!variances) return variances.error();
  if (!(scale->minCoeff() > 0)) {
    return InvalidData(named.origin + ": its tensor scale is not positive");
  }
  pose::PoseBasis& basis = models.basis;
  basis.mean = Eigen::Map<const Eigen::VectorXf>(mean->values.data(), dof).cast<double>();
  const Eigen::VectorXd sd = variances->col(0).cwiseMax(0).cwiseSqrt();
  Eigen::Index count = 0;
  while (count < sd.size() && sd(count) > kLeastSd) ++count;
  if (count == 0) return InvalidData(named.origin + ": its poses do not vary");
  const Eigen::MatrixXd rows = components->topRows(count);
  basis.modes = scale->col(0).cwiseInverse().asDiagonal() * rows.transpose();
  basis.inverse = rows * scale->col(0).asDiagonal();
  basis.sd = sd.head(count);
  basis.lower = -kReach * basis.sd;
  basis.upper = kReach * basis.sd;
  models.dofs = mean->labels;
  if (model::FindAny(named.model, "root_height_m") != nullptr) {
    const auto height = read("root_height_m", 1, 1);
    if (!height) return height.error();
    models.root_height_m = (*height)(0, 0);
    if (!(models.root_height_m > 0.1)) {
      return InvalidData(named.origin + ": its tensor root_height_m is not a height");
    }
  }
  if (model::FindAny(named.model, "first_sd") != nullptr) {
    const auto first = read("first_sd", dof, 1);
    if (!first) return first.error();
    const auto second = read("second_sd", dof, 1);
    if (!second) return second.error();
    models.rates = {first->col(0).head(count), second->col(0).head(count)};
  }
  models.origin = named.origin;
  return {};
}

Result<void> ReadNetworks(const NamedModel& named, Models& models) {
  auto x = cascade::FromTensors(named.model, "x.", named.origin);
  if (!x) return x.error();
  auto y = cascade::FromTensors(named.model, "y.", named.origin);
  if (!y) return y.error();
  for (const cascade::CascadeNetwork* network : {&*x, &*y}) {
    if (network->weights().inputs != momentum::kNetworkInputs || network->weights().outputs != 1) {
      return InvalidData(named.origin + ": its networks have " +
                         std::to_string(network->weights().inputs) + " inputs and " +
                         std::to_string(network->weights().outputs) + " outputs; " +
                         std::to_string(momentum::kNetworkInputs) + " and 1 belong");
    }
  }
  models.horizontal = std::array{std::move(*x), std::move(*y)};
  return {};
}

}  // namespace

Result<Models> MakeModels(const std::vector<NamedModel>& models) {
  Models made;
  std::vector<std::string> kinds;
  for (const NamedModel& named : models) {
    const std::string& kind = named.model.kind;
    if (std::find(kinds.begin(), kinds.end(), kind) != kinds.end()) {
      return UsageError(named.origin + ": a second model of kind " + kind + "; give one of each");
    }
    kinds.push_back(kind);
    const auto read = kind == "basis" ? ReadBasis(named, made)
                      : kind == "com"
                          ? ReadNetworks(named, made)
                          : Result<void>(InvalidData(named.origin + ": a model of kind " + kind +
                                                     "; the pose engine takes basis and com"));
    if (!read) return read.error();
  }
  if (made.dofs.empty()) {
    return UsageError("no model of kind basis: train one with footing-train basis");
  }
  return made;
}

}  // namespace footing::reconstruction
