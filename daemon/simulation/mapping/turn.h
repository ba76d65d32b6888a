#pragma once

#include <optional>

#include "daemon/simulation/mapping/mapping_table.h"

namespace footing::mapping {

/// How an inclination turns the character: beyond the dead band by a constant angle a step (gait
/// paper, section 7). The borders are radians, or shares where something else than an angle turns.
struct TurnMapping {
  double turn_above = 0;
  double straight_below = 0;
  double turn_per_step_rad = 0;

  bool IsOrdered() const { return straight_below <= turn_above; }
};

/// Fields turn_above_deg, straight_below_deg and turn_per_step_deg; as_share: the borders are
/// turn_above and straight_below, from 0 to 1.
void AddFields(TurnMapping& mapping, bool as_share, TableFields& fields);

/// The dead band with its hysteresis. A plain value.
class Turn {
 public:
  /// How long a turn goes on while what commands it is not known, s.
  static constexpr double kHoldS = 0.5;

  explicit Turn(const TurnMapping& mapping) : mapping_(mapping) {}

  /// `right`: how far to the right, in the unit of the borders; none while it is not known. The
  /// turn a step, positive to the left.
  double Advance(double time_s, std::optional<double> right);
  /// Straight on.
  void Rest();

  bool valid() const { return valid_; }
  /// 1: turns to the right, -1: to the left, 0: straight on.
  int side() const { return side_; }
  /// The newest `right`, as a share of the border at which turning begins.
  double share() const { return share_; }

 private:
  TurnMapping mapping_;
  int side_ = 0;
  double known_s_ = 0;
  bool valid_ = false;
  double share_ = 0;
};

}  // namespace footing::mapping
