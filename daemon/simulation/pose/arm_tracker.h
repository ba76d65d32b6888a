#pragma once

#include <array>
#include <optional>

#include "daemon/simulation/pose/arm_model.h"
#include "daemon/simulation/pose/arm_network.h"
#include "daemon/simulation/pose/hand_attitude.h"

namespace footing::arms {

/// Estimate of an arm's directions, in W, with its covariance.
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

/// Where a device of an arm is: in the fist, or strapped along the upper arm or the forearm, with
/// its x towards the hand.
enum class Place { kFist, kUpperArm, kForearm };
inline constexpr std::size_t kPlaces = 3;
/// For each arm by Place: whether the device is there and heard.
using Heard = std::array<std::array<bool, kPlaces>, kArms>;
inline constexpr Heard kAllHeard{{{true, true, true}, {true, true, true}}};

/// Both arms from what the devices on them measure: in the fists, strapped on upper arms and
/// forearms, or both. An arm needs the one in its fist, and a model, or both straps. A value that
/// can be copied; no allocation after its making. Its past is that of the sensors, never its own
/// estimates: it cannot run away. The network of paper mode does go by its own estimates.
class ArmTracker {
 public:
  /// Without a model devices in the fists count for nothing, without a network not in paper mode.
  explicit ArmTracker(const std::optional<ArmModel>& model,
                      const std::optional<arm_network::ArmNetwork>& network = std::nullopt);
  /// From now on the network says how arms with a device in the fist are held, or the regression.
  void UseNetwork(bool use) { uses_network_ = use; }

  /// A sample of one device, `step_s` after its last.
  void Add(std::size_t arm, const HandReading& reading, double step_s, Place place = Place::kFist);
  /// A T-pose begins: the readings so far do not count. Nothing for devices that are aligned.
  void BeginTPose();
  /// The T-pose is held and was for some seconds.
  void Align();
  /// A device was not heard for too long to know how it has turned: it counts for nothing until the
  /// next Align.
  void Lose(std::size_t arm, Place place = Place::kFist);
  /// How the arms are held now, `step_s` after the last call. Invalid before Align.
  const std::array<ArmEstimate, kArms>& Advance(double step_s, const Heard& heard = kAllHeard);

  /// Features of the last Advance; only when both fists are aligned.
  const ArmFeatures& features() const { return features_; }
  bool aligned() const { return hand(0).valid && hand(1).valid; }
  /// Attitude of the device at that place, in W.
  const HandState& hand(std::size_t arm, Place place = Place::kFist) const {
    return devices_[arm][static_cast<std::size_t>(place)].state();
  }

 private:
  HandState StateOf(std::size_t arm, Place place, const Heard& heard) const;
  ArmEstimate Estimate(std::size_t arm, const Heard& heard);
  ArmEstimate NetworkEstimate(std::size_t arm) const;
  void AdvanceNetwork(double step_s);

  std::optional<ArmModel> model_;
  std::optional<arm_network::ArmNetwork> network_;
  bool uses_network_ = false;
  std::array<arm_network::ArmPose, kArms> network_poses_;  ///< As of left arms.
  double network_s_ = 0;                                   ///< Since its last step.
  std::array<std::array<HandAttitude, kPlaces>, kArms> devices_;
  ArmFeatures features_;
  ArmFeatures::Values values_ = ArmFeatures::Values::Zero();
  std::array<ArmEstimate, kArms> estimates_;
};

}  // namespace footing::arms
