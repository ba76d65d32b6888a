#pragma once

#include <string>

#include "common/result/result.h"

namespace footing::mapping {

/// Two ends of a linear, clamped scaling from a person's comfortable range to the character's
/// stable one (gait paper, section 7).
struct Scaling {
  double from_min = 0, from_max = 1;
  double to_min = 0, to_max = 1;

  double operator()(double from) const;
};

/// The table of wrist_mapping.json; angles are degrees there.
struct WristMapping {
  Scaling walk_mps_from_hz;
  Scaling run_mps_from_hz;
  Scaling jump_mps_from_hz;
  Scaling jump_m_from_mps2;
  double walk_run_border_hz = 0;
  double walk_run_hysteresis_hz = 0;  ///< On either side of the border.
  double in_phase_below_rad = 0;
  double out_of_phase_above_rad = 0;
  double turn_above_rad = 0;  ///< Dead band of the inclination, with its hysteresis.
  double straight_below_rad = 0;
  double turn_per_step_rad = 0;
  double hold_s = 0;  ///< How long a gait goes on while features are not valid.
};

/// Reads wrist_mapping.json: every key, nothing unknown, all in range. `origin` names the file.
Result<WristMapping> ParseWristMapping(const std::string& text, const std::string& origin);

}  // namespace footing::mapping
