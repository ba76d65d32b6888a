#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "common/model/model.h"
#include "common/virtual/motion/motion.h"

namespace footing::learning {

/// Principal components of poses (pose paper, section 6): pose = mean + sum of a_k component_k over
/// scale, entry by entry. All components are kept, greatest variance first: those of one person
/// that are cut off are what another person's poses are missing.
struct PoseBasis {
  std::vector<std::string> dofs;  ///< Names of the pose's entries.
  Eigen::VectorXd mean;           ///< m and rad.
  Eigen::VectorXd scale;          ///< By which an entry counts; a metre is as much as 2.5 rad.
  Eigen::MatrixXd components;     ///< Rows of length 1, at right angles.
  Eigen::VectorXd variances;      ///< Of each component's a, divided by the number of poses.

  /// Components that hold the part `fraction` of the variance.
  int ComponentsFor(double fraction) const;
};

/// Of poses in columns: aligned motions (alignment.h) of one skeleton layout. The sign of a
/// component is such that its greatest entry is positive.
PoseBasis MakeBasis(const Eigen::MatrixXd& poses, std::vector<std::string> dofs);

/// Appends mean, scale, components and variances, labelled with the dofs.
void AppendTensors(const PoseBasis& basis, model::Model& model);

}  // namespace footing::learning
