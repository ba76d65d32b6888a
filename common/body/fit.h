#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "common/body/kinematics.h"
#include "common/body/skeleton.h"

namespace footing::body {

/// A point of the skeleton that should be at a place.
struct PointTarget {
  int joint = 0;
  Eigen::Vector3d p_J = Eigen::Vector3d::Zero();  ///< Fixed to the joint's frame, m.
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< Where it should be, m.
  double weight = 1;                              ///< Not negative.
};

struct FitOptions {
  int iterations = 10;  ///< At most.
  /// What it costs a coordinate to be away from `neutral`, against the points: m/rad (of the root's
  /// position: 1). Coordinates that no point shows go there. Null: 0.01 each.
  const Eigen::VectorXd* hold = nullptr;
  const Eigen::VectorXd* neutral = nullptr;  ///< Null: the pose at the start.
  double still = 1e-7;  ///< It has arrived when the cost falls by less than this part of itself.
};

/// Least squares of a pose to points by Gauss-Newton with damping (Levenberg-Marquardt). The caller
/// owns it; made once for a skeleton, Fit allocates nothing but for the first time with more
/// points.
class PoseFit {
 public:
  explicit PoseFit(const Skeleton& skeleton);

  /// Moves `q` so that the points come near their places. Returns the root of the weighted mean
  /// square of their distances, m; `q` is no worse than it was.
  double Fit(const std::vector<PointTarget>& targets, const FitOptions& options,
             Eigen::Ref<Eigen::VectorXd> q);

 private:
  /// Where the descent has come to.
  struct Descent {
    double points = 0;   ///< Cost of the points, m².
    double cost = 0;     ///< The same and what holds the coordinates.
    double gain = 0;     ///< By which the last step lowered the cost.
    double damping = 0;  ///< Of the next step, relative to H's diagonal.
  };

  void SetHold(const FitOptions& options, const Eigen::Ref<const Eigen::VectorXd>& q);
  double PointCost(const std::vector<PointTarget>& targets, const Eigen::VectorXd& q);
  double HoldCost(const Eigen::VectorXd& q) const;
  /// Sets H_ and gradient_ at the pose.
  void Linearise(const std::vector<PointTarget>& targets,
                 const Eigen::Ref<const Eigen::VectorXd>& q);
  /// Raises the damping until a step does not raise the cost, and takes it; false if none does.
  bool Step(const std::vector<PointTarget>& targets, Descent& descent,
            Eigen::Ref<Eigen::VectorXd> q);

  const Skeleton& skeleton_;
  Kinematics at_;
  Eigen::MatrixXd J_, H_, damped_;
  Eigen::VectorXd residuals_, gradient_, hold_, neutral_, trial_, step_;
  Eigen::LLT<Eigen::MatrixXd> solver_;
};

}  // namespace footing::body
