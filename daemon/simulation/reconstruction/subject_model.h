#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/body/points.h"
#include "common/base/result.h"
#include "daemon/simulation/pose/arm_geometry.h"
#include "daemon/simulation/cascade/network.h"
#include "daemon/simulation/momentum/calibration.h"
#include "daemon/simulation/pose/leg_ik.h"
#include "daemon/simulation/reconstruction/feet.h"
#include "daemon/simulation/reconstruction/inputs.h"
#include "daemon/simulation/reconstruction/models.h"
#include "daemon/simulation/reconstruction/options.h"

namespace footing::reconstruction {

using JointPoints = std::array<body::Point, stream::kBodyJoints>;  ///< By body::IndexOf.

/// What never changes while one person is reconstructed; the steps of a mode point into it.
struct SubjectModel {
  body::Body body;
  Eigen::VectorXd t_pose;
  body::Kinematics t_pose_at{body::Skeleton{}};  ///< Where it has the joints.
  momentum::Subject subject;
  std::array<FootGeometry, momentum::kFeet> feet;
  std::array<std::vector<std::size_t>, momentum::kFeet> shanks;  ///< Joints from the knees down.
  std::array<std::vector<std::size_t>, kHands> arm_joints;       ///< From the shoulders down.
  std::array<body::Point, kHands> fists;
  JointPoints joints;                   ///< Those of a tracked skeleton.
  std::vector<arms::ArmGeometry> arms;  ///< kHands.
  pose::PoseBasis basis;
  PoseRegression regression;  ///< Empty where the mode does without.
  pose::PoseBasis rest;       ///< Errors of the regression.
  LikelyPoses posture;        ///< Of hands and feet alone; empty likewise.
  std::optional<std::array<cascade::CascadeNetwork, 2>> horizontal;

  double root_height_m() const { return t_pose(2); }
};

/// The body with the learned poses at its size: as many components as each mode takes. Errors where
/// the poses have another layout than the body.
Result<SubjectModel> BestSubjectModel(const body::Body& body, const Models& models,
                                      const Options& options);
Result<SubjectModel> PaperSubjectModel(const body::Body& body, const Models& models,
                                       const Options& options);
/// Best mode's, without the regression, whose people stay in place.
Result<SubjectModel> WalkSubjectModel(const body::Body& body, const Models& models,
                                      const Options& options);

pose::LegIk LegOf(const SubjectModel& model, std::size_t foot);

/// Where in W the basis has the origin of its poses: below the middle of the feet of the T-pose.
Eigen::Vector3d BasisOrigin(const SubjectModel& model, const momentum::TPose& pose);

}  // namespace footing::reconstruction
