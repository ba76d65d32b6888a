#include "daemon/simulation/pose/arm_model.h"

#include <utility>

namespace footing::arms {
namespace {

constexpr double kMostScaled = 4;

Result<Eigen::MatrixXd> Read(const model::Model& model, const std::string& name, std::uint32_t rows,
                             std::uint32_t columns, const std::string& origin) {
  const auto tensor = columns == 1 ? model::Find(model, name, {rows}, origin)
                                   : model::Find(model, name, {rows, columns}, origin);
  if (!tensor) return tensor.error();
  using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::MatrixXd(
      Eigen::Map<const Rows>((*tensor)->values.data(), rows, columns).cast<double>());
}

}  // namespace

Directions Stacked(const ArmDirections& arm) {
  Directions stacked;
  stacked << arm.upper, arm.hinge, arm.forearm;
  return stacked;
}

ArmDirections Of(const Directions& stacked) {
  ArmDirections arm;
  const auto take = [&](Eigen::Index first, Eigen::Vector3d& direction) {
    const Eigen::Vector3d predicted = stacked.segment<3>(first);
    if (predicted.norm() > 1e-3) direction = predicted.normalized();
  };
  take(0, arm.upper);
  take(3, arm.hinge);
  take(6, arm.forearm);
  return arm;
}

ArmDirections Mirrored(const ArmDirections& arm) {
  return {MirroredWay(arm.upper), MirroredWay(arm.hinge), MirroredWay(arm.forearm)};
}

Directions ArmModel::Predict(ArmFeatures::Values& features, bool other_known) const {
  features = (features - mean).cwiseProduct(scale).cwiseMax(-kMostScaled).cwiseMin(kMostScaled);
  if (!other_known) features.segment<ArmFeatures::kOther>(ArmFeatures::kOtherAt).setZero();
  Directions directions = offset;
  directions.noalias() += weights * features;
  return directions;
}

Result<ArmModel> MakeArmModel(const model::Model& model, const std::string& origin) {
  if (const auto kind = model::CheckKind(model, "arm", origin); !kind) return kind.error();
  constexpr auto kFeatures = static_cast<std::uint32_t>(ArmFeatures::kCount);
  constexpr auto kOut = static_cast<std::uint32_t>(kDirections);
  const auto mean = Read(model, "feature_mean", kFeatures, 1, origin);
  if (!mean) return mean.error();
  const auto scale = Read(model, "feature_scale", kFeatures, 1, origin);
  if (!scale) return scale.error();
  auto weights = Read(model, "regression_weights", kOut, kFeatures, origin);
  if (!weights) return weights.error();
  const auto offset = Read(model, "regression_offset", kOut, 1, origin);
  if (!offset) return offset.error();
  const auto covariance = Read(model, "error_covariance", kOut, kOut, origin);
  if (!covariance) return covariance.error();
  if (!(covariance->diagonal().minCoeff() > 0)) {
    return InvalidData(origin +
                       ": its tensor error_covariance has a variance that is not positive");
  }
  return ArmModel{*mean, *scale, std::move(*weights), *offset, *covariance};
}

}  // namespace footing::arms
