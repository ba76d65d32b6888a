#include "clients/game/rules/piece.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::game {
namespace {

constexpr double kMostSlopeRad = 5 * kPi / 180;   // Section 8.2.
constexpr double kMostCurveRad = 15 * kPi / 180;  // Section 8.2.
constexpr double kMostStepM = 0.10;               // Section 8.2.
constexpr double kLeastLengthM = 2, kMostLengthM = 4;
constexpr double kPieceS = 1;
constexpr double kLeastPitM = 0.3, kMostPitM = 1.5;
constexpr double kMostHeadingRad = kPi / 2;

/// -1 to 1; 0 within the dead zone.
double ShareOf(double inclination_rad) {
  const double beyond_rad = std::fabs(inclination_rad) - kDeadZoneRad;
  if (!(beyond_rad > 0)) return 0;
  const double share = std::min(1.0, beyond_rad / (kFullRad - kDeadZoneRad));
  return std::copysign(share, inclination_rad);
}

/// The curve, cut so that the track goes on within 90 degrees of where it began.
double Bounded(double curve_rad, const stream::Track& track) {
  const double heading_rad = track.segments.back().heading_rad;
  return std::clamp(curve_rad, std::min(0.0, -kMostHeadingRad - heading_rad),
                    std::max(0.0, kMostHeadingRad - heading_rad));
}

}  // namespace

Piece Held(const Hand& hand, const stream::Track& track, double speed_mps, bool pits) {
  Piece piece;
  piece.length_m = std::clamp(kPieceS * speed_mps, kLeastLengthM, kMostLengthM);
  if (!hand.known) return piece;
  const bool after_pit = track.segments.back().pit;
  const double up = ShareOf(hand.pitch_rad);
  if (pits && hand.b && !after_pit) {
    piece.pit = true;
    piece.length_m = kLeastPitM + (kMostPitM - kLeastPitM) * std::max(0.0, up);
    return piece;
  }
  if (!after_pit) piece.curve_rad = Bounded(-kMostCurveRad * ShareOf(hand.roll_rad), track);
  (hand.a ? piece.step_m : piece.slope_rad) = up * (hand.a ? kMostStepM : kMostSlopeRad);
  return piece;
}

}  // namespace footing::game
