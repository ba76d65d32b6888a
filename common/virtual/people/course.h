#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/virtual/people/script.h"

namespace footing::choreography {

/// The channels through time at equal steps: one entry a frame, from 0 to the script's end. A step
/// lifts its foot by itself.
std::vector<Values> Sample(const Script& script, double rate_hz);

/// How the pressure wanders while somebody stands: a sum of sines of 0.1 to 1.1 Hz with this root
/// mean square each way, 0 at time 0. The same for everybody.
Eigen::Vector2d Sway(double sway_m, double t_s);

}  // namespace footing::choreography
