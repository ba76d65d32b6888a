#pragma once

#include <cstdint>

#include "common/virtual/people/felt.h"
#include "common/virtual/people/rhythm.h"
#include "common/virtual/people/sight.h"

namespace footing::users {

/// A thumb on the stick of a Nunchuk, and the other on button A of the Wiimote. A plain value.
class StickBody {
 public:
  StickBody(const Style& style, std::uint64_t seed);

  void Advance(const Intention& wanted, double step_s);
  void Feel(Felt& felt) const;
  stream::Gait gesture() const { return gesture_; }
  double limb_hz() const { return 0; }

 private:
  Style style_;
  noise::Random random_;
  double bias_rad_;  ///< Straight on as this thumb does it.
  Follower right_, front_;
  double tremor_ = 0;
  bool wanted_jump_ = false;
  double pressed_s_ = 0;  ///< The button is down for this much longer.
  stream::Gait gesture_ = stream::Gait::kStep;
};

}  // namespace footing::users
