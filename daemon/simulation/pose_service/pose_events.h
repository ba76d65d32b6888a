#pragma once

#include <cstdint>

#include "daemon/simulation/pose_service/pose_frame.h"
#include "daemon/simulation/pose_service/subject_body.h"
#include "footing/v1/character.pb.h"

namespace footing::pose_service {

/// What a person should learn once, from one frame to the next: boards or insoles lost and back
/// and which of them is followed, Wiimotes lost and back, a T-pose asked for and taken, the next
/// subject, filters that were reset.
class PoseEvents {
 public:
  v1::Events Between(const PoseFrame& frame, const Subject& subject, std::int64_t now_ns);

 private:
  void AddHands(const PoseFrame& frame, std::int64_t now_ns, v1::Events& events);

  std::array<HandTrouble, reconstruction::kHands> hand_trouble_{};
  bool has_last_ = false;
  bool measured_ = false;
  PoseSource source_ = PoseSource::kBoards;
  bool calibrated_ = false;
  std::uint64_t subject_number_ = 0;
  std::uint32_t resets_ = 0;
};

}  // namespace footing::pose_service
