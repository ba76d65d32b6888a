#pragma once

#include <array>
#include <string>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/model/model.h"
#include "daemon/simulation/pose/hand_attitude.h"

namespace footing::arms {

inline constexpr std::size_t kArms = 2;  ///< 0 is the left one.

/// Features of an arm for a linear regression, from two hands' states and their past. Everything is
/// in W and is mirrored for the right arm, so that one regression serves both. The body faces along
/// x.
class ArmFeatures {
 public:
  static constexpr int kTurn = 9, kHistories = 3;
  static constexpr int kOtherAt = kTurn + 12 + kTurn * kHistories;  ///< Features of the other hand.
  static constexpr int kOther = kTurn + 3;
  static constexpr int kLinear = kOtherAt + kOther;
  static constexpr int kProducts = kTurn * (kTurn + 1) / 2;
  static constexpr int kCount = kLinear + kProducts;
  using Values = Eigen::Matrix<double, kCount, 1>;

  /// The next frame of both hands.
  void Advance(const std::array<HandState, kArms>& hands, double step_s);
  /// Features of one arm, in the left arm's frame.
  void Compute(std::size_t arm, Values& out) const;

 private:
  using Turn = Eigen::Matrix<double, kTurn, 1>;
  struct Hand {
    Turn turn = Turn::Zero();
    Eigen::Vector3d turning = Eigen::Vector3d::Zero(), force = Eigen::Vector3d::Zero();
    Eigen::Vector3d speed = Eigen::Vector3d::Zero(), way = Eigen::Vector3d::Zero();
    std::array<Turn, kHistories> slow{Turn::Zero(), Turn::Zero(), Turn::Zero()};
  };
  bool started_ = false;
  std::array<Hand, kArms> hands_;
};

/// A vector of the right arm as the left arm's, and back.
inline Eigen::Vector3d MirroredWay(const Eigen::Vector3d& v) { return {v.x(), -v.y(), v.z()}; }

/// How an arm is held, by unit vectors in W: three angles of the shoulder (`upper`, and `hinge`
/// about it) and one of the elbow (between `upper` and `forearm`).
struct ArmDirections {
  Eigen::Vector3d upper = Eigen::Vector3d::UnitY();  ///< Shoulder to elbow.
  Eigen::Vector3d hinge = Eigen::Vector3d::UnitZ();  ///< Hinge of the upper arm: up in the T-pose.
  Eigen::Vector3d forearm = Eigen::Vector3d::UnitY();  ///< Elbow to the middle of the fist.
};

/// One arm of a body, of side 0 (left) or 1.
struct ArmGeometry {
  int shoulder = 0, elbow = 0;
  body::Point fist;
  Eigen::Vector3d hinge_J = Eigen::Vector3d::UnitZ();  ///< In the shoulder's frame.
  double upper_m = 0, forearm_m = 0;                   ///< Lengths in the T-pose.

  ArmGeometry(const body::Body& body, int side);

  ArmDirections Directions(const body::Kinematics& at) const;
  /// From the shoulder to the fist, W.
  Eigen::Vector3d Hand(const ArmDirections& arm) const {
    return upper_m * arm.upper + forearm_m * arm.forearm;
  }
};

/// Angle by which one upper arm is turned against the other, and the difference of the elbows'
/// angles, rad.
double ShoulderError(const ArmDirections& a, const ArmDirections& b);
double ElbowError(const ArmDirections& a, const ArmDirections& b);

/// Entries of ArmDirections: upper, hinge, forearm.
inline constexpr int kDirections = 9;
using Directions = Eigen::Matrix<double, kDirections, 1>;

/// The three directions in one vector.
Directions Stacked(const ArmDirections& arm);
/// The same as unit vectors; those of a T-pose where the numbers have no direction.
ArmDirections Of(const Directions& stacked);
/// A right arm as a left one, and back: the mirror image at the plane y = 0.
ArmDirections Mirrored(const ArmDirections& arm);

/// From features to how an arm is held, learned (docs/models.md), and how far off that is.
struct ArmModel {
  ArmFeatures::Values mean, scale;  ///< Scaling of the features: (f - mean) scale, cut at +-4.
  Eigen::MatrixXd weights;          ///< kDirections x ArmFeatures::kCount.
  Directions offset;
  /// Covariance of the errors on persons that were left out, in the left arm's frame.
  Eigen::Matrix<double, kDirections, kDirections> covariance;

  /// Writes the scaled features to `features`. Where nothing is known of the other hand, what it
  /// says is what it said in the mean.
  Directions Predict(ArmFeatures::Values& features, bool other_known = true) const;
};

/// InvalidData where a tensor is missing or of another shape; `origin` names the file.
Result<ArmModel> MakeArmModel(const model::Model& model, const std::string& origin);

/// How an arm is held, and one standard deviation along W's axes (no unit: parts of a length).
struct ArmEstimate {
  bool valid = false;
  ArmDirections directions;
  Eigen::Vector3d upper_sd = Eigen::Vector3d::Ones(), hinge_sd = Eigen::Vector3d::Ones(),
                  forearm_sd = Eigen::Vector3d::Ones();
};

}  // namespace footing::arms
