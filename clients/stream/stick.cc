#include "clients/stream/stick.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/units.h"

namespace footing::stream_client {
namespace {

constexpr double kWalkRadius = 0.45;  // Well inside 0.6 of figure 11.
constexpr double kRunRadius = 0.9;
constexpr double kRunFrequencyHz = 2;  // From here on the wrists command a run.
/// The wrists turn by 20 degrees of inclination; the stick goes to 60 for it.
constexpr double kStickPerRoll = 3;
constexpr double kMaxAngleRad = 75 * kPi / 180;
constexpr double kPressS = 0.1;

bool Jumps(const wrists::Segment& segment) {
  return segment.amplitude_mps2 > 0 && std::abs(WrapAngle(segment.phase_rad)) < kPi / 2;
}

/// Where the stick stands in this stretch: right, front.
std::pair<double, double> Place(const wrists::Segment& segment) {
  if (segment.amplitude_mps2 == 0) return {0, 0};
  const bool runs = !Jumps(segment) && segment.frequency_hz > kRunFrequencyHz;
  const double radius = runs ? kRunRadius : kWalkRadius;
  const double angle_rad =
      std::clamp(kStickPerRoll * segment.roll_rad, -kMaxAngleRad, kMaxAngleRad);
  return {radius * std::sin(angle_rad), radius * std::cos(angle_rad)};
}

}  // namespace

StickMotion::StickMotion(std::vector<wrists::Segment> segments, double blend_s)
    : segments_(std::move(segments)), blend_s_(blend_s) {
  for (const wrists::Segment& segment : segments_) duration_s_ += segment.duration_s;
}

StickState StickMotion::At(double t_s) const {
  double into_s = std::max(0.0, t_s);
  std::size_t i = 0;
  for (; i + 1 < segments_.size() && into_s >= segments_[i].duration_s; ++i) {
    into_s -= segments_[i].duration_s;
  }
  const wrists::Segment& segment = segments_[i];
  const auto [from_x, from_y] = Place(segments_[i == 0 ? 0 : i - 1]);
  const auto [x, y] = Place(segment);
  const double share = into_s < blend_s_ ? into_s / blend_s_ : 1;
  StickState state;
  state.x = from_x + (x - from_x) * share;
  state.y = from_y + (y - from_y) * share;
  state.jump = Jumps(segment) && std::fmod(into_s, 1 / segment.frequency_hz) < kPressS;
  return state;
}

}  // namespace footing::stream_client
