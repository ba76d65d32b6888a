#include "daemon/simulation/engine/failure.h"

#include <algorithm>
#include <cmath>

#include "daemon/simulation/biped/ground.h"
#include "daemon/simulation/biped/track.h"

namespace footing::engine {
namespace {

using stream::FailureCause;

/// A fall is put down to what a foot is over when the foot is lower than this over the ribbon, m:
/// legs shorten in a fall, and a foot in the air is higher.
constexpr double kLowFootM = 0.1;
/// Only with a foot this far under the ribbon is what it is over looked up without a fall, m.
constexpr double kSunkM = 0.05;

/// What of the ground a foot has missed.
struct MissedGround {
  bool pit = false, pit_deep = false, edge = false;
};

MissedGround Missed(const stream::Track& track, const biped::BodyState& body) {
  MissedGround missed;
  for (const biped::LegState& leg : body.legs) {
    const Eigen::Vector2d p_W = leg.p_WF.head<2>();
    const terrain::TrackPlace place = terrain::Locate(track, p_W);
    const stream::TrackSegment& segment = track.segments[static_cast<std::size_t>(place.segment)];
    const double depth_m = terrain::RibbonHeight(segment, place) - leg.p_WF.z();
    const bool beside = terrain::IsOffRibbon(track, place);
    missed.edge = missed.edge || (beside && depth_m > -kLowFootM);
    missed.pit = missed.pit || (segment.pit && !beside && depth_m > -kLowFootM);
    missed.pit_deep = missed.pit_deep || (segment.pit && !beside && depth_m > kFootInPitM);
  }
  return missed;
}

const char* WhyFallen(double ground_m, const biped::BodyState& body,
                      const physics::Observation& seen) {
  if (seen.diverged) return "the simulation diverged";
  if (body.p_WB.z() - ground_m < kLowestBodyM) return "the body is below 0.55 m";
  if (body.R_WB(2, 2) < std::cos(kLargestTiltRad)) return "the body tilts over 60 degrees";
  if (seen.other_contact) return "something else than a foot touches";
  return nullptr;
}

}  // namespace

Failure FindFailure(const stream::Track& track, const terrain::TrackPlace& place,
                    const biped::BodyState& body, const physics::Observation& seen) {
  const stream::TrackSegment& segment = track.segments[static_cast<std::size_t>(place.segment)];
  const char* why = WhyFallen(terrain::RibbonHeight(segment, place), body, seen);
  if (terrain::HasPlane(track)) return {FailureCause::kSimulation, why};
  const bool beside = !track.open && terrain::IsOffRibbon(track, place);
  // Both feet high and nothing wrong: no need to look what is under them.
  const double lowest_foot_m = std::min(body.legs[0].p_WF.z(), body.legs[1].p_WF.z());
  const bool sunk = lowest_foot_m < terrain::RibbonHeight(segment, place) - kSunkM;
  const MissedGround missed = sunk || why != nullptr ? Missed(track, body) : MissedGround{};
  if (missed.pit_deep) return {FailureCause::kJump, "a foot is in a pit"};
  if (beside) return {FailureCause::kCurve, "the body is beside the track"};
  if (missed.pit) return {FailureCause::kJump, why};
  return {missed.edge ? FailureCause::kCurve : FailureCause::kSimulation, why};
}

bool MissesPit(const stream::Track& track, const terrain::TrackPlace& place,
               const biped::BodyState& body) {
  const auto& segments = track.segments;
  const auto at = static_cast<std::size_t>(place.segment);
  const std::size_t first = at > 0 ? at - 1 : 0, last = std::min(at + 1, segments.size() - 1);
  bool near = false;
  for (std::size_t i = first; i <= last; ++i) near = near || segments[i].pit;
  if (!near) return false;
  return std::any_of(
      body.legs.begin(), body.legs.end(), [&track, &segments](const biped::LegState& leg) {
        const terrain::TrackPlace foot = terrain::Locate(track, leg.p_WF.head<2>());
        const stream::TrackSegment& segment = segments[static_cast<std::size_t>(foot.segment)];
        if (!segment.pit || terrain::IsOffRibbon(track, foot)) return false;
        // Over a pit there is nothing to touch but its edges and walls.
        return leg.touching || leg.p_WF.z() < terrain::RibbonHeight(segment, foot) - kSunkM;
      });
}

}  // namespace footing::engine
