#pragma once

#include <array>
#include <cstdint>

#include "common/stream/user_interface.h"
#include "common/virtual/people/body_pose.h"
#include "common/virtual/people/felt.h"
#include "common/virtual/people/rhythm.h"
#include "common/virtual/people/sight.h"

namespace footing::users {

/// A person who swings two remotes from the wrists, or with the arms, or who steps in place with
/// one on each shin and one on the head or the trunk. A plain value.
class LimbBody {
 public:
  /// `turn_by`: of who steps, the head or the trunk inclines, or one foot is lifted higher.
  LimbBody(stream::UserInterface interface, const Style& style, std::uint64_t seed,
           stream::TurnSource turn_by);

  void Advance(const Intention& wanted, double step_s);
  void Feel(Felt& felt) const;
  stream::Gait gesture() const { return gesture_; }
  double limb_hz() const { return rhythm_.activity() > 0.05 ? rhythm_.frequency_hz() : 0; }

 private:
  static constexpr std::size_t kSensors = 3;
  using Poses = std::array<SensorPose, kSensors>;

  Poses PosesNow() const;
  SensorPose HandNow(bool left) const;
  SensorPose ShinNow(bool left) const;
  SensorPose TrunkNow() const;
  double LiftedBy(bool left) const;
  double PelvisRise() const;

  stream::UserInterface interface_;
  stream::TurnSource turn_by_;
  Style style_;
  Rhythm rhythm_;
  Follower turn_;  ///< Of hands, head or trunk, to the right: the left side up. Of feet: a share.
  Follower bend_;  ///< Elbow.
  Follower hop_;   ///< 0 stepping to 1 hopping with both legs.
  Follower run_;   ///< 0 walking to 1 running.
  stream::Gait gesture_ = stream::Gait::kStep;
  double step_s_ = 1;
  std::array<Poses, 3> poses_;  ///< The newest last.
};

}  // namespace footing::users
