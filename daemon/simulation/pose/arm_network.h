#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/model/model.h"
#include "daemon/simulation/cascade/network.h"
#include "daemon/simulation/pose/arm_model.h"

/// Arm poses by a network that receives its own last estimate (Ha, Bai & Liu 2011, section 5.2):
/// the arms of paper mode, and to compare with the regression (docs/hands.md).
namespace footing::arm_network {

inline constexpr double kRateHz = 60;  ///< Frames a second, in training and use.

/// Inputs and outputs of a network.
enum class Kind {
  kPaper,     ///< {q_a(t), a, omega} to q_a(t + 1), a and omega in the frame of the hand.
  kResidual,  ///< Residual of the kinematic prediction, from it and arms::ArmFeatures.
};

/// q_a of a left arm: four degrees of freedom.
struct ArmPose {
  Eigen::Matrix3d R_WU = Eigen::Matrix3d::Identity();  ///< Upper arm; I in the T-pose.
  double elbow_rad = 0;
};

/// `elbow_axis_U`: a unit vector about which the elbow bends.
arms::ArmDirections ToDirections(const ArmPose& pose, const Eigen::Vector3d& elbow_axis_U);
ArmPose ToPose(const arms::ArmDirections& arm);

/// The least joint velocities (in their squares' sum) whose hand turns as the gyroscope says,
/// J^+ omega of the paper's equation 4 with a stiff wrist, over a step.
ArmPose Predicted(const ArmPose& pose, const Eigen::Vector3d& elbow_axis_U,
                  const Eigen::Vector3d& angular_velocity_W_radps, double step_s);

/// Measurements of one frame of an arm, mirrored to a left one. H: the frame of the device, turned
/// by what it had been turned from W in the T-pose, so that the grip does not matter.
struct FrameInput {
  Eigen::Vector3d specific_force_H_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_H_radps = Eigen::Vector3d::Zero();
  arms::ArmFeatures::Values features = arms::ArmFeatures::Values::Zero();
  Eigen::Vector3d angular_velocity_W_radps = Eigen::Vector3d::Zero();
};

/// The input of an arm whose device is aligned, and both hands' features; all finite.
FrameInput MakeInput(std::size_t arm, const arms::HandState& state,
                     const arms::ArmFeatures& features);

inline constexpr std::size_t kOutputs = 4;
/// Number of inputs of such a network.
std::size_t InputCount(Kind kind);

/// The network's inputs. `last` is the estimate of the frame before; of kResidual its prediction.
Eigen::VectorXd NetworkInputs(Kind kind, const ArmPose& last, const Eigen::Vector3d& elbow_axis_U,
                              const FrameInput& frame);
/// The outputs that lead from `last` (as above) to `next`, and the way there.
Eigen::Vector4d NetworkTarget(Kind kind, const ArmPose& last, const ArmPose& next);
/// The pose that the outputs lead to from `last`.
ArmPose Applied(Kind kind, const ArmPose& last, const Eigen::Vector4d& output);

/// A recurrent network that estimates an arm's pose frame by frame.
struct ArmNetwork {
  Kind kind = Kind::kPaper;
  Eigen::Vector3d elbow_axis_U = Eigen::Vector3d::UnitZ();
  cascade::CascadeNetwork network;

  /// The estimate after `last`, one frame later.
  ArmPose Next(const ArmPose& last, const FrameInput& frame, double step_s) const;
};

/// "arm_paper" or "arm_residual", as a model's kind.
std::string KindName(Kind kind);

/// Appends the network to a model file's tensors.
void AppendTensors(const ArmNetwork& network, model::Model& model);
/// InvalidData where the model is of another kind or its tensors do not fit; `origin` names it.
Result<ArmNetwork> MakeArmNetwork(const model::Model& model, const std::string& origin);

}  // namespace footing::arm_network
