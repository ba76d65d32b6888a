#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

#include "common/stream/hands.h"
#include "daemon/simulation/pose/arm_model.h"
#include "daemon/simulation/pose/hand_attitude.h"
#include "daemon/simulation/momentum/contact_loads.h"

namespace footing::reconstruction {

inline constexpr std::size_t kHands = 2;  ///< 0 is the left one.

/// A point of the body as a tracker sees it.
struct PointInput {
  bool valid = false;
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d sd_m = Eigen::Vector3d::Constant(0.01);
  /// Of x and y, x and z, y and z; with sd_m the whole matrix.
  Eigen::Vector3d covariance_m2 = Eigen::Vector3d::Zero();
  bool of_skeleton = false;  ///< A hand that the tracker of the joints alone sees.
};
using HandInput = PointInput;   ///< Middle of the fist (body::Fist).
using JointInput = PointInput;  ///< A joint of a skeleton (body::SkeletonPoints).
using JointInputs = std::array<JointInput, stream::kBodyJoints>;  ///< By body::IndexOf.

/// What the sensors measure in one frame.
struct Inputs {
  momentum::ContactLoads loads;
  std::array<HandInput, kHands> hands;
  /// How the arms are held, where their hands are not seen.
  std::array<arms::ArmEstimate, kHands> arms = {};
  JointInputs joints = {};
  /// How the pelvis has turned since the T-pose, by a device on a belt.
  arms::HandState belt = {};
};

/// For evaluation: parts of the truth at the instant of the loads, in place of their estimates, to
/// see how much a better estimate would help. Empty in the daemon.
struct Truth {
  /// Joints of one foot, W.
  struct Foot {
    Eigen::Vector3d ankle_W_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d toe_W_m = Eigen::Vector3d::Zero();
  };
  std::optional<Eigen::Vector3d> com_W_m;
  std::optional<Eigen::Vector3d> angular_W;  ///< kg m^2/s, of the body's own mass.
  std::optional<std::array<Foot, momentum::kFeet>> feet;
};

/// Where the model of a walk expects the joints of one foot, with one standard deviation.
struct FootPrior {
  Eigen::Vector3d ankle_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d toe_W_m = Eigen::Vector3d::Zero();
  double ankle_sd_m = 0, toe_sd_m = 0;
};

/// What the model of a walk expects of a frame (InsoleWalk).
struct WalkPrior {
  struct Com {
    Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d sd_m = Eigen::Vector3d::Ones();
  };
  std::array<FootPrior, momentum::kFeet> feet;
  std::optional<Com> com;  ///< Where the hands show the place of the body.
};

}  // namespace footing::reconstruction
