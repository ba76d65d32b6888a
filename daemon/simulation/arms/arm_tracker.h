#pragma once

#include <array>

#include "daemon/simulation/arms/arm_features.h"
#include "daemon/simulation/arms/arm_model.h"
#include "daemon/simulation/arms/hand_attitude.h"

namespace footing::arms {

/// Both arms from what the devices in the fists measure. A value that can be copied; no allocation
/// after its making. Its past is that of the sensors, never its own estimates: it cannot run away.
class ArmTracker {
 public:
  explicit ArmTracker(const ArmModel& model);

  /// A sample of one hand, `step_s` after its last.
  void Add(std::size_t arm, const HandReading& reading, double step_s);
  /// A T-pose begins: the readings so far do not count. Nothing for hands that are aligned.
  void BeginTPose();
  /// The T-pose is held and was for some seconds.
  void Align();
  /// A device was not heard for too long to know how it has turned. Its arm is invalid until the
  /// next Align; the other one is estimated without it.
  void Lose(std::size_t arm);
  /// How the arms are held now, `step_s` after the last call. Invalid before Align.
  const std::array<ArmEstimate, kArms>& Advance(double step_s);

  /// Of the last Advance; only when both hands are aligned.
  const ArmFeatures& features() const { return features_; }
  bool aligned() const { return hands_[0].state().valid && hands_[1].state().valid; }
  const HandState& hand(std::size_t arm) const { return hands_[arm].state(); }

 private:
  ArmModel model_;
  std::array<HandAttitude, kArms> hands_;
  ArmFeatures features_;
  ArmFeatures::Values values_ = ArmFeatures::Values::Zero();
  std::array<ArmEstimate, kArms> estimates_;
};

}  // namespace footing::arms
