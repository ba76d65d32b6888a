#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/body/body.h"

namespace footing::pose {

/// Angles of hips, knees, ankles and elbows, and which of them a pose has beyond the skeleton's
/// limits. Those of trunk and shoulders are left out: people exceed them, one axis at a time, when
/// they throw or reach up.
///
/// Nothing allocates after the constructor.
class JointLimits {
 public:
  struct Excess {
    int dof = 0;
    double back_rad = 0;  ///< From q to the limit.
  };

  explicit JointLimits(const body::Body& body);

  void Measure(const Eigen::VectorXd& q);
  /// Of the pose measured last, in the order of the degrees of freedom.
  const std::vector<Excess>& excesses() const { return excesses_; }
  /// The most that a pose can have.
  int most() const { return static_cast<int>(dofs_.size()); }

 private:
  std::vector<int> dofs_;
  Eigen::VectorXd lower_rad_, upper_rad_;
  std::vector<Excess> excesses_;
};

}  // namespace footing::pose
