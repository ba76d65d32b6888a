#include "daemon/simulation/mapping/turn.h"

#include <algorithm>
#include <cmath>

#include "daemon/simulation/biped/limits.h"

namespace footing::mapping {

void AddFields(TurnMapping& mapping, bool as_share, TableFields& fields) {
  if (as_share) {
    fields.push_back({"turn_above", &mapping.turn_above, 0.01, 1});
    fields.push_back({"straight_below", &mapping.straight_below, 0, 1});
  } else {
    fields.push_back({"turn_above_deg", &mapping.turn_above, 1, 90, Unit::kDegrees});
    fields.push_back({"straight_below_deg", &mapping.straight_below, 0, 90, Unit::kDegrees});
  }
  fields.push_back({"turn_per_step_deg", &mapping.turn_per_step_rad, 0, biped::kTurnPerStepMaxDeg,
                    Unit::kDegrees});
}

void Turn::Rest() {
  side_ = 0;
  valid_ = false;
  share_ = 0;
}

double Turn::Advance(double time_s, std::optional<double> right) {
  valid_ = right.has_value();
  if (right) {
    known_s_ = time_s;
    share_ = std::clamp(*right / mapping_.turn_above, -3.0, 3.0);
    const bool inclined = *right * side_ > 0;
    const double border = inclined ? mapping_.straight_below : mapping_.turn_above;
    side_ = std::fabs(*right) <= border ? 0 : *right > 0 ? 1 : -1;
  } else if (time_s - known_s_ > kHoldS) {
    Rest();
  }
  return -side_ * mapping_.turn_per_step_rad;
}

}  // namespace footing::mapping
