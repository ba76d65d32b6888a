#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/body/landmarks.h"
#include "common/body/skeleton.h"

/// Skeletons with masses, and the standard person. Masses and inertias of body segments: P. de
/// Leva, "Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters", J. Biomechanics 29
/// (1996) 1223-1230, Table 4.
namespace footing::body {

enum class Sex { kFemale, kMale, kMean };

/// Rigid segments of the body; a segment of a limb stands for both sides.
enum class Segment {
  kHead,        ///< Cervicale (C7) to vertex, the neck included.
  kUpperTrunk,  ///< Cervicale to xiphion.
  kMiddleTrunk,
  kLowerTrunk,  ///< Omphalion to the middle of the hip joints.
  kUpperArm,
  kForearm,
  kHand,  ///< Wrist to the third knuckle.
  kThigh,
  kShank,
  kFoot,  ///< Heel to tip of the toes.
};
inline constexpr int kSegmentCount = 10;

/// One row of the table. Lengths and radii are fractions, so that they scale with the person.
struct SegmentParameters {
  std::string_view name;
  double length_of_stature;    ///< Length over standing height.
  double mass_of_body;         ///< Mass over body mass; of one side.
  double centre_of_length;     ///< Centre of mass from the first end named above, over the length.
  double sagittal_radius;      ///< Radii of gyration about the centre of mass, over the length:
  double transverse_radius;    ///< about the fore-aft, the left-right
  double longitudinal_radius;  ///< and the long axis.
};

/// Parameters of one sex, or the mean of both. Masses sum to 1 with the limbs counted twice.
SegmentParameters Parameters(Segment segment, Sex sex);

/// Centre of mass of a part of the trunk over the line from mid-hip (0) to mid-shoulder (1), and
/// the cervicale on the same line (beyond 1), from the same table. The shoulders, since the neck
/// joint of motion files is anywhere between suprasternale and skull.
double TrunkCentre(Segment trunk_part, Sex sex);
double CervicaleOnTrunk(Sex sex);

/// Standing height over thigh + shank + (mid-hip to mid-shoulder), from the same table.
double StatureOfLengths(Sex sex);

/// Mid-hip to mid-shoulder over standing height.
double TrunkOfStature(Sex sex);

/// Mass that moves rigidly with one joint's frame.
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

/// Size and mass of a person, from which a body is made.
struct PersonParameters {
  double mass_kg = 75;
  /// Standing height; without it, it follows from the lengths of legs and trunk.
  std::optional<double> height_m = std::nullopt;
  Sex sex = Sex::kMean;
  /// A pose in which trunk and head are upright in line, where the rest pose is not (some rigs).
  std::optional<Eigen::VectorXd> upright_pose = std::nullopt;
};

/// Standing height by the lengths of thighs, shanks and trunk.
double EstimateHeight(const Skeleton& skeleton, const Landmarks& landmarks,
                      const PersonParameters& person);

/// Hangs the segments on a skeleton whose lengths are those of the person. Mass must be in
/// [10, 400] kg and the height, given or estimated, in [0.5, 2.6] m: an error says which is not
/// (a file in other units than its reader took shows here).
Result<Body> MakeBody(const Skeleton& skeleton, const PersonParameters& person);

/// The same with each segment's mass, centre and inertia as they are, times `mass_kg` over the
/// body's mass: what a calibration on the boards changes.
Body WithMass(Body body, double mass_kg);

/// 56 degrees of freedom, proportions of the table of segments, in the joint layout of the CMU
/// skeletons without their fingers, so that a pose of one is a pose of the other: for a user of
/// whom nothing but height is known. Its rest pose is a T-pose with the legs 20 degrees apart.
Skeleton StandardPerson(double height_m, Sex sex = Sex::kMean);

/// T-pose of the standard person (and of a CMU skeleton): arms level, legs straight down, the
/// lowest point at z = 0, root above the origin, looking along x.
Eigen::VectorXd TPose(const Skeleton& skeleton, const Landmarks& landmarks);

}  // namespace footing::body
