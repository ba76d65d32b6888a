#include "daemon/offline/learning/network.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Dense>
#include <Eigen/Geometry>

#include "common/base/result.h"
#include "common/virtual/devices/noise.h"
#include "daemon/offline/learning/cascade.h"
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

FrameInput MakeInput(std::size_t arm, const arms::HandReading& reading,
                     const arms::HandState& state, const arms::ArmFeatures& features) {
  FrameInput frame{reading.specific_force_S_mps2,
                   reading.angular_velocity_S_radps,
                   {},
                   state.angular_velocity_W_radps};
  if (arm == 1) {
    frame.specific_force_S_mps2 = arms::MirroredWay(frame.specific_force_S_mps2);
    frame.angular_velocity_S_radps = -arms::MirroredWay(frame.angular_velocity_S_radps);
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
    inputs << RotationVector(last.R_WU), last.elbow_rad, frame.specific_force_S_mps2,
        frame.angular_velocity_S_radps;
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

namespace {

constexpr double kTrainShare = 0.8;
constexpr double kBentRad = 0.4;  // Less shows no axis.
constexpr double kPieceS = 2;     // For which the network is left alone, or taught.

Eigen::Vector3d ElbowAxis(const std::vector<Sequence>& sequences) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Sequence& sequence : sequences) {
    for (std::size_t i = 0; i < sequence.truth.size(); ++i) {
      const ArmPose& pose = sequence.truth[i];
      if (pose.elbow_rad < kBentRad) continue;
      const Eigen::Vector3d forearm_U = pose.R_WU.transpose() * sequence.forearm[i];
      sum += Eigen::Vector3d::UnitY().cross(forearm_U).normalized();
    }
  }
  FOOTING_CHECK(sum.norm() > 0);
  return sum.normalized();
}

ArmPose Disturbed(const ArmPose& pose, const Eigen::Vector4d& by) {
  return Applied(Kind::kResidual, pose, by);
}

class Rows {
 public:
  void Add(const Eigen::VectorXd& inputs, const Eigen::Vector4d& target) {
    inputs_.push_back(inputs);
    targets_.push_back(target);
  }
  learning::Examples Take() const {
    const auto count = static_cast<Eigen::Index>(inputs_.size());
    learning::Examples all{.inputs = Eigen::MatrixXd(count, inputs_.front().size()),
                           .targets = Eigen::MatrixXd(count, static_cast<Eigen::Index>(kOutputs))};
    for (Eigen::Index i = 0; i < count; ++i) {
      all.inputs.row(i) = inputs_[static_cast<std::size_t>(i)].transpose();
      all.targets.row(i) = targets_[static_cast<std::size_t>(i)].transpose();
    }
    return all;
  }
  std::size_t size() const { return inputs_.size(); }

 private:
  std::vector<Eigen::VectorXd> inputs_;
  std::vector<Eigen::Vector4d> targets_;
};

/// One pass over a sequence: the rows of what the network would receive. `taught`: probability
/// that a piece begins at the true pose and stays there.
class Pass {
 public:
  Pass(Kind kind, const Eigen::Vector3d& axis, const TrainingOptions& options, double taught,
       const std::optional<ArmNetwork>& network, noise::Random& random)
      : kind_(kind),
        axis_(axis),
        options_(options),
        taught_(taught),
        network_(network),
        random_(random) {}

  void Run(const Sequence& sequence, Rows& train, Rows& validation) {
    const auto piece = static_cast<std::size_t>(std::lround(kPieceS / sequence.step_s));
    const auto trains =
        static_cast<std::size_t>(kTrainShare * static_cast<double>(sequence.truth.size()));
    ArmPose own = sequence.truth.front();
    bool taught = true;
    Eigen::Vector4d noise = Eigen::Vector4d::Zero();
    for (std::size_t i = 1; i < sequence.truth.size(); ++i) {
      if (i % piece == 1) {
        taught = !network_ || random_.Uniform(0, 1) < taught_;
        for (double& value : noise) value = options_.noise_rad * random_.Normal();
      }
      const FrameInput& frame = sequence.inputs[i];
      const ArmPose last = taught ? Disturbed(sequence.truth[i - 1], noise) : own;
      if (i % static_cast<std::size_t>(options_.every) == 0) {
        const ArmPose from =
            kind_ == Kind::kResidual
                ? Predicted(last, axis_, frame.angular_velocity_W_radps, sequence.step_s)
                : last;
        (i < trains ? train : validation)
            .Add(NetworkInputs(kind_, from, axis_, frame),
                 NetworkTarget(kind_, from, sequence.truth[i]));
      }
      if (network_) own = network_->Next(last, frame, sequence.step_s);
    }
  }

 private:
  Kind kind_;
  Eigen::Vector3d axis_;
  TrainingOptions options_;
  double taught_;
  const std::optional<ArmNetwork>& network_;
  noise::Random& random_;
};

/// RMS of the three directions' errors on the last fifths, the network left alone from the start.
double ClosedLoopError(const ArmNetwork& network, const std::vector<Sequence>& sequences) {
  double squares = 0;
  std::size_t count = 0;
  for (const Sequence& sequence : sequences) {
    const auto trains =
        static_cast<std::size_t>(kTrainShare * static_cast<double>(sequence.truth.size()));
    ArmPose pose = sequence.truth.front();
    for (std::size_t i = 1; i < sequence.truth.size(); ++i) {
      pose = network.Next(pose, sequence.inputs[i], sequence.step_s);
      if (i < trains) continue;
      const auto estimate = ToDirections(pose, network.elbow_axis_U);
      const auto truth = ToDirections(sequence.truth[i], network.elbow_axis_U);
      squares += (estimate.upper - truth.upper).squaredNorm() +
                 (estimate.hinge - truth.hinge).squaredNorm() +
                 (estimate.forearm - truth.forearm).squaredNorm();
      ++count;
    }
  }
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, count)));
}

}  // namespace

TrainingOptions PaperOptions() {
  TrainingOptions options;
  options.rounds = 1;
  options.noise_rad = 0;
  options.every = 4;
  return options;
}

Trained Train(Kind kind, const std::vector<Sequence>& sequences, const TrainingOptions& options,
              std::uint64_t seed) {
  FOOTING_CHECK(!sequences.empty() && options.rounds >= 1);
  const Eigen::Vector3d axis = ElbowAxis(sequences);
  noise::Random random(seed);
  Rows train, validation;
  std::optional<ArmNetwork> network;
  std::optional<Trained> best;
  learning::CascadeOptions cascade_options;
  cascade_options.hidden_max = options.hidden_max;
  for (int round = 0; round < options.rounds; ++round) {
    const double taught = options.rounds > 1 ? 1 - round / (options.rounds - 1.0) : 1;
    Pass pass(kind, axis, options, taught, network, random);
    for (const Sequence& sequence : sequences) pass.Run(sequence, train, validation);
    auto result = learning::TrainCascade(train.Take(), validation.Take(), cascade_options, seed);
    network = ArmNetwork{kind, axis, result.network};
    Trained trained{*network, result.hidden_units, round, ClosedLoopError(*network, sequences),
                    train.size()};
    if (!best || trained.closed_loop < best->closed_loop) best = std::move(trained);
  }
  return *best;
}

}  // namespace footing::arm_network
