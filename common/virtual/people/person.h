#pragma once

#include <cstdint>
#include <variant>

#include "common/stream/user_interface.h"
#include "common/virtual/people/board_body.h"
#include "common/virtual/people/felt.h"
#include "common/virtual/people/limb_body.h"
#include "common/virtual/people/sight.h"
#include "common/virtual/people/stick_body.h"
#include "common/virtual/people/style.h"

namespace footing::users {

/// The body of a user of one interface: turns an intention into motion, and motion into what the
/// devices feel. Its own clock runs in even steps. A plain value.
class Person {
 public:
  static constexpr double kStepS = 0.0025;

  /// kUnspecified counts as the wrist. `turn_by` is what turns with the leg interface.
  Person(stream::UserInterface interface, const Style& style, std::uint64_t seed,
         stream::TurnSource turn_by = stream::TurnSource::kHead);

  /// Moves on to `time_s`; an earlier one changes nothing.
  void Advance(double time_s, const Intention& wanted);
  const Felt& felt() const { return felt_; }
  /// The gait that the motion now under way is meant to command: a jump's gesture is over before
  /// the user's wish for a jump is.
  stream::Gait gesture() const;
  /// Of one limb, at its tempo now; 0: no limb swings.
  double limb_hz() const;

 private:
  std::variant<LimbBody, StickBody, BoardBody> body_;
  double time_s_ = 0;
  Felt felt_;
};

}  // namespace footing::users
