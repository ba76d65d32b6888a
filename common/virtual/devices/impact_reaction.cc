#include "common/virtual/devices/impact_reaction.h"

#include <algorithm>

#include "common/base/units.h"
#include "common/virtual/motion/signal.h"

namespace footing::virtual_sensors {
namespace {

// Chosen on two drop jumps, two walks and a rise from a chair of one person
// (docs/evaluation/momentum.md).
constexpr double kSmoothForceHz = 8;
constexpr double kHardPoseHz = 10, kHardForceHz = 12;
constexpr double kHardShare = 0.05;  // Of the weight: by which both forces differ at an impact.
constexpr double kHardHz = 4;        // Of the difference's mean square.

}  // namespace

GroundReaction ReactToImpacts(const body::Body& body, const motion::Motion& motion,
                              const BodyCourse& smooth) {
  GroundReaction out = React(smooth, kSmoothForceHz);
  const GroundReaction hard = React(Follow(body, motion, kHardPoseHz), kHardForceHz);
  const Eigen::MatrixXd apart = hard.force_n - out.force_n;
  const Eigen::MatrixXd square = apart.colwise().squaredNorm();
  const Eigen::MatrixXd energy = motion::LowPass(square, motion.rate_hz, kHardHz);
  const double known_n = kHardShare * smooth.mass_kg * kStandardGravityMps2;
  for (Eigen::Index i = 0; i < smooth.frames(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double here = std::max(energy(0, i), 0.0);
    const double share = here / (here + known_n * known_n);
    out.force_n.col(i) += share * apart.col(i);
    if (hard.supported[at] && out.supported[at]) {
      out.cop_m.col(i) += share * (hard.cop_m.col(i) - out.cop_m.col(i));
    } else if (share > 0.5) {
      out.cop_m.col(i) = hard.cop_m.col(i);
      out.supported[at] = hard.supported[at];
    }
  }
  return out;
}

}  // namespace footing::virtual_sensors
