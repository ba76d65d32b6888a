#pragma once

#include <cstdint>

#include "common/virtual/people/felt.h"
#include "common/virtual/people/rhythm.h"
#include "common/virtual/people/sight.h"

namespace footing::users {

/// A person with a foot on each of two Balance Boards, 2 cm apart, who steps and runs in place,
/// leans, and rises on the toes to jump. A plain value.
class BoardBody {
 public:
  BoardBody(const Style& style, std::uint64_t seed);

  void Advance(const Intention& wanted, double step_s);
  void Feel(Felt& felt) const;
  stream::Gait gesture() const { return gesture_; }
  double limb_hz() const { return rhythm_.activity() > 0.05 ? rhythm_.frequency_hz() : 0; }

 private:
  double RightShare() const;
  double Load(double bounce_mps2) const;
  void Rise(double step_s);

  Style style_;
  noise::Random random_;
  Rhythm rhythm_;
  Follower lean_m_;  ///< Of the COM, to the right.
  Follower run_;     ///< 0 stepping to 1 running.
  Follower toes_m_;  ///< COP, forward of where it is in standing.
  double sway_m_ = 0;
  double rises_s_ = -1;   ///< Since the jump's gesture began, standing included; negative: none.
  double rise_size_ = 1;  ///< As it was begun.
  double lift_mps2_ = 0;  ///< Acceleration of the COM in a heel rise.
  stream::Gait gesture_ = stream::Gait::kStep;
};

}  // namespace footing::users
