#include "daemon/simulation/pose/arm_network.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Dense>
#include <Eigen/Geometry>

#include "common/base/units.h"
#include "daemon/simulation/cascade/network.h"

namespace footing::arm_network {
namespace {

constexpr double kMostElbowRad = 2.8;
constexpr Eigen::Index kDirections = 9;
constexpr int kFeatures = arms::ArmFeatures::kLinear;

Eigen::Matrix3d Turn(const Eigen::Vector3d& rotation) {
  const double angle = rotation.norm();
  if (angle < 1e-12) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
}

Eigen::Vector3d RotationVector(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

ArmPose Moved(const ArmPose& pose, const Eigen::Vector3d& rotation_W, double elbow_rad) {
  return {Eigen::Quaterniond(Turn(rotation_W) * pose.R_WU).normalized().toRotationMatrix(),
          std::clamp(pose.elbow_rad + elbow_rad, 0.0, kMostElbowRad)};
}

}  // namespace

arms::ArmDirections ToDirections(const ArmPose& pose, const Eigen::Vector3d& elbow_axis_U) {
  return {pose.R_WU.col(1), pose.R_WU.col(2),
          pose.R_WU * (Eigen::AngleAxisd(pose.elbow_rad, elbow_axis_U) * Eigen::Vector3d::UnitY())};
}

ArmPose ToPose(const arms::ArmDirections& arm) {
  ArmPose pose;
  pose.R_WU.col(1) = arm.upper.normalized();
  pose.R_WU.col(2) = (arm.hinge - arm.hinge.dot(pose.R_WU.col(1)) * pose.R_WU.col(1)).normalized();
  pose.R_WU.col(0) = pose.R_WU.col(1).cross(pose.R_WU.col(2));
  pose.elbow_rad = std::acos(std::clamp(arm.upper.dot(arm.forearm), -1.0, 1.0));
  return pose;
}

ArmPose Predicted(const ArmPose& pose, const Eigen::Vector3d& elbow_axis_U,
                  const Eigen::Vector3d& angular_velocity_W_radps, double step_s) {
  // J = (I, axis), so J^+ = J' (I + axis axis')^-1 = J' (I - axis axis' / 2).
  const Eigen::Vector3d axis_W = pose.R_WU * elbow_axis_U;
  const double elbow_radps = axis_W.dot(angular_velocity_W_radps) / 2;
  return Moved(pose, step_s * (angular_velocity_W_radps - elbow_radps * axis_W),
               step_s * elbow_radps);
}

FrameInput MakeInput(std::size_t arm, const arms::HandState& state,
                     const arms::ArmFeatures& features) {
  const Eigen::Matrix3d R_HW = state.turn_W.transpose();
  FrameInput frame{
      R_HW * (state.acceleration_W_mps2 + kStandardGravityMps2 * Eigen::Vector3d::UnitZ()),
      R_HW * state.angular_velocity_W_radps,
      {},
      state.angular_velocity_W_radps};
  if (arm == 1) {
    frame.specific_force_H_mps2 = arms::MirroredWay(frame.specific_force_H_mps2);
    frame.angular_velocity_H_radps = -arms::MirroredWay(frame.angular_velocity_H_radps);
    frame.angular_velocity_W_radps = -arms::MirroredWay(frame.angular_velocity_W_radps);
  }
  features.Compute(arm, frame.features);
  return frame;
}

std::size_t InputCount(Kind kind) {
  return kind == Kind::kPaper ? 10 : static_cast<std::size_t>(kDirections + kFeatures);
}

Eigen::VectorXd NetworkInputs(Kind kind, const ArmPose& last, const Eigen::Vector3d& elbow_axis_U,
                              const FrameInput& frame) {
  Eigen::VectorXd inputs(static_cast<Eigen::Index>(InputCount(kind)));
  if (kind == Kind::kPaper) {
    inputs << RotationVector(last.R_WU), last.elbow_rad, frame.specific_force_H_mps2,
        frame.angular_velocity_H_radps;
  } else {
    const arms::ArmDirections arm = ToDirections(last, elbow_axis_U);
    inputs << arm.upper, arm.hinge, arm.forearm, frame.features.head<kFeatures>();
  }
  return inputs;
}

Eigen::Vector4d NetworkTarget(Kind kind, const ArmPose& last, const ArmPose& next) {
  Eigen::Vector4d target;
  if (kind == Kind::kPaper) {
    target << RotationVector(next.R_WU), next.elbow_rad;
  } else {
    target << RotationVector(next.R_WU * last.R_WU.transpose()), next.elbow_rad - last.elbow_rad;
  }
  return target;
}

ArmPose Applied(Kind kind, const ArmPose& last, const Eigen::Vector4d& output) {
  if (kind == Kind::kResidual) return Moved(last, output.head<3>(), output(3));
  return Moved({}, output.head<3>(), output(3));
}

ArmPose ArmNetwork::Next(const ArmPose& last, const FrameInput& frame, double step_s) const {
  const ArmPose from = kind == Kind::kResidual
                           ? Predicted(last, elbow_axis_U, frame.angular_velocity_W_radps, step_s)
                           : last;
  const Eigen::VectorXf inputs = NetworkInputs(kind, from, elbow_axis_U, frame).cast<float>();
  std::array<float, kOutputs> outputs;
  network.Evaluate({inputs.data(), static_cast<std::size_t>(inputs.size())}, outputs);
  return Applied(kind, from, Eigen::Vector4f::Map(outputs.data()).cast<double>());
}

std::string KindName(Kind kind) { return kind == Kind::kPaper ? "arm_paper" : "arm_residual"; }

void AppendTensors(const ArmNetwork& network, model::Model& model) {
  const Eigen::Vector3f axis = network.elbow_axis_U.cast<float>();
  model.tensors.push_back(
      {.name = "elbow_axis", .shape = {3}, .values = {axis.x(), axis.y(), axis.z()}});
  cascade::AppendTensors(network.network, "", model);
}

Result<ArmNetwork> MakeArmNetwork(const model::Model& model, const std::string& origin) {
  const Kind kind = model.kind == KindName(Kind::kResidual) ? Kind::kResidual : Kind::kPaper;
  if (const auto good = model::CheckKind(model, KindName(kind), origin); !good) return good.error();
  const auto axis = model::Find(model, "elbow_axis", {3}, origin);
  if (!axis) return axis.error();
  const Eigen::Vector3d axis_U = Eigen::Vector3f::Map((*axis)->values.data()).cast<double>();
  if (axis_U.norm() < 0.5) return InvalidData(origin + ": its elbow_axis is not a unit vector");
  auto network = cascade::FromTensors(model, "", origin);
  if (!network) return network.error();
  const cascade::NetworkWeights& weights = network->weights();
  if (weights.inputs != InputCount(kind) || weights.outputs != kOutputs) {
    return InvalidData(origin + ": a network of " + std::to_string(weights.inputs) +
                       " inputs and " + std::to_string(weights.outputs) +
                       " outputs, not of an arm");
  }
  return ArmNetwork{kind, axis_U.normalized(), std::move(network).value()};
}

}  // namespace footing::arm_network
