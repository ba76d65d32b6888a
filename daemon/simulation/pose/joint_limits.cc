#include "daemon/simulation/pose/joint_limits.h"

#include <algorithm>

#include "common/body/landmarks.h"

namespace footing::pose {

JointLimits::JointLimits(const body::Body& body)
    : lower_rad_(body::LowerLimits(body.skeleton)), upper_rad_(body::UpperLimits(body.skeleton)) {
  using body::Landmark;
  for (const Landmark left :
       {Landmark::kLeftHip, Landmark::kLeftKnee, Landmark::kLeftAnkle, Landmark::kLeftElbow}) {
    for (int side = 0; side < 2; ++side) {
      const body::Joint& joint = body.skeleton.joint(body.landmarks[body::OfSide(left, side)]);
      for (std::size_t i = 0; i < joint.rotations.size(); ++i) {
        dofs_.push_back(joint.first_dof + static_cast<int>(i));
      }
    }
  }
  std::sort(dofs_.begin(), dofs_.end());
  excesses_.reserve(dofs_.size());
}

void JointLimits::Measure(const Eigen::VectorXd& q) {
  excesses_.clear();
  for (const int dof : dofs_) {
    const double inside_rad = std::clamp(q(dof), lower_rad_(dof), upper_rad_(dof));
    if (inside_rad != q(dof)) excesses_.push_back({dof, inside_rad - q(dof)});
  }
}

}  // namespace footing::pose
