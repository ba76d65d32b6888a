#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "common/body/landmarks.h"
#include "common/body/segments.h"
#include "common/body/skeleton.h"
#include "common/base/result.h"

namespace footing::body {

/// What moves rigidly with one joint's frame.
struct JointMass {
  double mass_kg = 0;
  Eigen::Vector3d com_J = Eigen::Vector3d::Zero();      ///< m.
  Eigen::Matrix3d inertia_J = Eigen::Matrix3d::Zero();  ///< About com_J, kg m^2.
};

/// A skeleton with masses.
struct Body {
  Skeleton skeleton;
  Landmarks landmarks;
  std::vector<JointMass> masses;  ///< One a joint; most joints of fingers and toes carry none.
  double mass_kg = 0;
  double height_m = 0;
};

struct PersonParameters {
  double mass_kg = 75;
  /// Standing height; without it, it follows from the lengths of legs and trunk.
  std::optional<double> height_m = std::nullopt;
  Sex sex = Sex::kMean;
  /// A pose in which trunk and head are upright in line, where the rest pose is not (some rigs).
  std::optional<Eigen::VectorXd> upright_pose = std::nullopt;
};

/// Standing height by the lengths of thighs, shanks and trunk (segments.h).
double EstimateHeight(const Skeleton& skeleton, const Landmarks& landmarks,
                      const PersonParameters& person);

/// Hangs the segments on a skeleton whose lengths are those of the person. Mass must be in
/// [10, 400] kg and the height, given or estimated, in [0.5, 2.6] m: an error says which is not
/// (a file in other units than its reader took shows here).
Result<Body> MakeBody(const Skeleton& skeleton, const PersonParameters& person);

/// The same with each segment's mass, centre and inertia as they are, times `mass_kg` over the
/// body's mass: what a calibration on the boards changes.
Body WithMass(Body body, double mass_kg);

/// 56 degrees of freedom, proportions of segments.h, in the joint layout of the CMU skeletons
/// without their fingers, so that a pose of one is a pose of the other: for a user of whom nothing
/// but height is known. Its rest pose is a T-pose with the legs 20 degrees apart.
Skeleton StandardPerson(double height_m, Sex sex = Sex::kMean);

/// T-pose of the standard person (and of a CMU skeleton): arms level, legs straight down, the
/// lowest point at z = 0, root above the origin, looking along x.
Eigen::VectorXd TPose(const Skeleton& skeleton, const Landmarks& landmarks);

}  // namespace footing::body
