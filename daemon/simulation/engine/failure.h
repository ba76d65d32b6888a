#pragma once

#include "common/stream/character.h"
#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/engine/engine.h"
#include "daemon/simulation/biped/world.h"
#include "daemon/simulation/biped/track.h"

namespace footing::engine {

/// The house's definition of a fall; put-backs count besides.
inline constexpr double kLowestBodyM = 0.55;
inline constexpr double kLargestTiltRad = 1.0471975511965976;  ///< 60 degrees.

/// A foot lower than this under the ribbon, in a pit, has missed the ground.
inline constexpr double kFootInPitM = 0.3;

/// A fall within this time of a foot that was in a pit, or stood on its edge, is the jump's.
inline constexpr double kStumbleS = 1;

/// A failure and why, as text of static storage; null when there is none.
struct Failure {
  stream::FailureCause cause = stream::FailureCause::kSimulation;
  const char* why = nullptr;
};

/// What is wrong with a state: simulation, curve or jump. What touches or drops beside the ribbon
/// is the curve's failure, with a foot in a pit the jump's, whatever else is wrong besides. `place`
/// is the body's on the track.
Failure FindFailure(const stream::Track& track, const terrain::TrackPlace& place,
                    const biped::BodyState& body, const physics::Observation& seen);

/// Whether a foot touches the edge of a pit, or is lower than the track over one: a jump that was
/// too short or badly timed. `place` is the body's on the track.
bool MissesPit(const stream::Track& track, const terrain::TrackPlace& place,
               const biped::BodyState& body);

}  // namespace footing::engine
