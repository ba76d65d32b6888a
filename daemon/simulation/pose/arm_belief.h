#pragma once

#include <array>

#include "daemon/simulation/pose/arm_model.h"
#include "daemon/simulation/pose/hand_attitude.h"

namespace footing::arms {

/// What is believed of an arm's directions, in W, and with what covariance.
struct ArmBelief {
  Directions directions = Directions::Zero();
  Eigen::Matrix<double, kDirections, kDirections> covariance =
      Eigen::Matrix<double, kDirections, kDirections>::Identity();
};

/// A device strapped on a segment.
enum class Segment { kUpperArm, kForearm };
inline constexpr std::size_t kSegments = 2;
using SegmentStates = std::array<HandState, kSegments>;  ///< By Segment.

/// How well a strap points along its segment about the vertical, and how far a wrist bends: the
/// fist's direction from the elbow beside the forearm's own. rad.
inline constexpr double kStrapHeadingSdRad = 0.07, kWristSdRad = 0.06;

/// An arm as the regression has it, `arm` 1 being the right one, with the attitude of the hand that
/// it follows: its deviations grow with those of the attitude, above all of the heading, by which
/// whatever the arm is believed to do is turned.
ArmBelief RegressedArm(std::size_t arm, const ArmModel& model, const Directions& predicted,
                       const HandState& hand);
/// The same where the segments that are valid have their devices' directions, too.
void Measure(std::size_t arm, const SegmentStates& segments, ArmBelief& belief);
/// The directions of an arm of which both segments are valid.
ArmBelief StrappedArm(std::size_t arm, const SegmentStates& segments);

/// One deviation along each axis, and unit vectors.
ArmEstimate ToEstimate(const ArmBelief& belief);

}  // namespace footing::arms
