#pragma once

#include <functional>

#include "common/body/body.h"
#include "common/virtual/people/script.h"
#include "common/virtual/motion/motion.h"

namespace footing::choreography {

/// The standard person of this height, for whom scripts are made.
Result<body::Body> Performer(double height_m, double mass_kg);

struct Performance {
  motion::Motion motion;
  double pressure_error_m = 0;  ///< Root mean square, of the centre of pressure from the script's.
  double foot_error_m = 0;      ///< Most, of a foot from its place.
};

/// The script as a motion of `body` (of Performer), from a T-pose at its first frame on. The feet
/// are where the script says, exactly. The centre of mass goes where the centre of pressure that
/// inverse dynamics find (virtual_sensors) is the script's: c - c_z c'' / (g + c_z'') = p with the
/// moment of the limbs in p, solved as a boundary value problem over the whole motion (Kajita et
/// al. 2003, "Biped walking pattern generation by using preview control of zero-moment point",
/// equation (9)) and repeated with what is left. `progress`, if any, hears the share done.
Performance Perform(const Script& script, const body::Body& body, double rate_hz = 100,
                    const std::function<void(double done)>& progress = nullptr);

}  // namespace footing::choreography
