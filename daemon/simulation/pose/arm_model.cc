#include "daemon/simulation/pose/arm_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

namespace footing::arms {
namespace {

constexpr std::array<double, ArmFeatures::kHistories> kHistoriesS{0.1, 0.3, 1.0};
constexpr double kForceS = 0.04, kForgetS = 0.4;  // Integrals of the acceleration leak.
constexpr double kMostMps2 = 30, kMostRadps = 20;

Eigen::Vector3d Clipped(const Eigen::Vector3d& value, double most) {
  return value.cwiseMax(-most).cwiseMin(most);
}

}  // namespace

void ArmFeatures::Advance(const std::array<HandState, kArms>& hands, double step_s) {
  for (std::size_t arm = 0; arm < kArms; ++arm) {
    const HandState& state = hands[arm];
    Hand& hand = hands_[arm];
    Eigen::Matrix3d turn = state.turn_W;
    Eigen::Vector3d turning = state.angular_velocity_W_radps, force = state.acceleration_W_mps2;
    if (arm == 1) {
      const Eigen::Vector3d mirror(1, -1, 1);
      turn = mirror.asDiagonal() * turn * mirror.asDiagonal();
      turning =
          -MirroredWay(turning);  // A turn is a pseudovector: its mirror image turns the other way.
      force = MirroredWay(force);
    }
    hand.turn = Eigen::Map<const Turn>(turn.data());
    hand.turning = Clipped(turning, kMostRadps);
    hand.force += (1 - std::exp(-step_s / kForceS)) * (Clipped(force, kMostMps2) - hand.force);
    const double kept = std::exp(-step_s / kForgetS);
    hand.speed = kept * (hand.speed + step_s * Clipped(force, kMostMps2));
    hand.way = kept * (hand.way + step_s * hand.speed);
    for (std::size_t k = 0; k < kHistories; ++k) {
      const double share = started_ ? 1 - std::exp(-step_s / kHistoriesS[k]) : 1;
      hand.slow[k] += share * (hand.turn - hand.slow[k]);
    }
  }
  started_ = true;
}

void ArmFeatures::Compute(std::size_t arm, Values& out) const {
  const Hand& own = hands_[arm];
  const Hand& other = hands_[1 - arm];
  Eigen::Index at = 0;
  const auto add = [&](const auto& part) {
    out.segment(at, part.size()) = part;
    at += part.size();
  };
  add(own.turn);
  add(own.turning);
  add(own.force);
  add(own.speed);
  add(own.way);
  for (const Turn& slow : own.slow) add((own.turn - slow).eval());
  add(other.turn);
  add(other.speed);
  for (Eigen::Index i = 0; i < kTurn; ++i) {
    for (Eigen::Index k = 0; k <= i; ++k) out(at++) = own.turn(i) * own.turn(k);
  }
}

namespace {

using body::Landmark;

Eigen::Vector3d Unit(const Eigen::Vector3d& v) {
  const double norm = v.norm();
  return norm > 1e-9 ? Eigen::Vector3d(v / norm) : Eigen::Vector3d::UnitZ();
}

double Angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(Unit(a).dot(Unit(b)), -1.0, 1.0));
}

Eigen::Matrix3d Frame(const ArmDirections& arm) {
  Eigen::Matrix3d frame;
  frame.col(0) = Unit(arm.upper);
  frame.col(1) = Unit(arm.hinge - arm.hinge.dot(frame.col(0)) * frame.col(0));
  frame.col(2) = frame.col(0).cross(frame.col(1));
  return frame;
}

}  // namespace

ArmGeometry::ArmGeometry(const body::Body& body, int side) : fist(body::Fist(body, side)) {
  const auto landmark = [&](Landmark left) {
    return body.landmarks[side == 0 ? left : body::Mirrored(left)];
  };
  shoulder = landmark(Landmark::kLeftShoulder);
  elbow = landmark(Landmark::kLeftElbow);
  body::Kinematics at(body.skeleton);
  body::ComputeKinematics(body.skeleton, body::TPose(body.skeleton, body.landmarks), at);
  const auto place = [&](int joint) { return at.p_WJ[static_cast<std::size_t>(joint)]; };
  hinge_J = at.R_WJ[static_cast<std::size_t>(shoulder)].transpose() * Eigen::Vector3d::UnitZ();
  upper_m = (place(elbow) - place(shoulder)).norm();
  forearm_m = (body::Place(fist, at) - place(elbow)).norm();
}

ArmDirections ArmGeometry::Directions(const body::Kinematics& at) const {
  const auto s = static_cast<std::size_t>(shoulder), e = static_cast<std::size_t>(elbow);
  return {Unit(at.p_WJ[e] - at.p_WJ[s]), at.R_WJ[s] * hinge_J,
          Unit(body::Place(fist, at) - at.p_WJ[e])};
}

double ShoulderError(const ArmDirections& a, const ArmDirections& b) {
  const double cosine = ((Frame(a).transpose() * Frame(b)).trace() - 1) / 2;
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

double ElbowError(const ArmDirections& a, const ArmDirections& b) {
  return std::abs(Angle(a.upper, a.forearm) - Angle(b.upper, b.forearm));
}

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
