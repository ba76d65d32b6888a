#pragma once

#include <cstdint>

#include "common/body/body.h"
#include "common/virtual/motion/motion.h"
#include "daemon/offline/learning/horizontal_com.h"

namespace footing::learning {

struct BoardLoadSettings {
  double noise_kg = 0.1;  ///< Of a cell.
  bool limited = true;    ///< Boards have an edge: virtual_sensors::LoadBoard.
  bool mirrored = false;  ///< The mirror image at the plane y = 0.
};

/// What two boards under the feet would measure while the body moves (common/virtual/sensors), at
/// momentum::kNetworkRateHz. Each board's middle is where its foot mostly is. The origin is half
/// way between the points of the soles where the COP is at rest, where the feet mostly are; as in
/// use, when it comes from a T-pose. `motion` is aligned (alignment.h); `body` is of its skeleton.
LoadClip BoardLoads(const motion::Motion& motion, const body::Body& body,
                    const BoardLoadSettings& settings, std::uint64_t seed);

}  // namespace footing::learning
