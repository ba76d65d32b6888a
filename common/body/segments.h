#pragma once

#include <array>
#include <string_view>

/// Masses and inertias of body segments: P. de Leva, "Adjustments to Zatsiorsky-Seluyanov's segment
/// inertia parameters", J. Biomechanics 29 (1996) 1223-1230, Table 4.
namespace footing::body {

enum class Sex { kFemale, kMale, kMean };

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

/// Of one sex, or the mean of both. Masses sum to 1 with the limbs counted twice.
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

}  // namespace footing::body
