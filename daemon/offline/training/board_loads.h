#pragma once

#include "common/body/body.h"
#include "common/motion/motion.h"
#include "daemon/offline/training/horizontal_com.h"

namespace footing::training {

struct BoardLoadSettings {
  double rate_hz = 60;
  double smoothing_s = 0.022;  ///< Standard deviation of a Gaussian on the coordinates: 6 Hz.
  double noise_sd = 0.0013;    ///< Of a cell, part of the weight.
};

/// What two boards under the feet would measure while the body moves: inverse dynamics of the whole
/// body give force and COP (contact without free moment about the level axes), which is shared by
/// the feet and then by the four cells of each board, whose middle is where its foot mostly is.
/// Cells answer linearly beyond the board's edge too, and to a force that pulls.
/// `motion` is aligned (alignment.h); `body` is of the same skeleton.
LoadClip BoardLoads(const motion::Motion& motion, const body::Body& body,
                    const BoardLoadSettings& settings, std::uint64_t seed);

}  // namespace footing::training
