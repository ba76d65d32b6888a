#include "daemon/simulation/engine/failure.h"

#include <cmath>

#include "daemon/simulation/terrain/ground.h"

namespace footing::engine {

const char* WhyFallen(const stream::Track& track, const biped::BodyState& body,
                      const physics::Observation& seen) {
  if (seen.diverged) return "the simulation diverged";
  const double ground_m = terrain::RibbonHeight(track, body.p_WB.x(), body.p_WB.y());
  if (body.p_WB.z() - ground_m < kLowestBodyM) return "the body is below 0.55 m";
  if (body.R_WB(2, 2) < std::cos(kLargestTiltRad)) return "the body tilts over 60 degrees";
  if (seen.other_contact) return "something else than a foot touches";
  return nullptr;
}

}  // namespace footing::engine
