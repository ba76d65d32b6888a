#include "clients/view/render/interface_gauges.h"

#include <algorithm>
#include <cmath>

#include "clients/view/scene/words.h"
#include "common/base/units.h"

namespace footing::render {
namespace {

using stream::Gait;

constexpr float kCaption = 14;
constexpr float kTint = 0.30f, kLit = 0.75f;
constexpr double kMostHz = 5, kMostFootHz = 2.5;
/// Of figure 11 as in the built-in table, shares of the stick's way and degrees from the front. A
/// person's own table may have other radii: what is lit is what the interface believes.
constexpr float kCentreRadius = 0.25f, kRunRadius = 0.6f;
constexpr double kStraightDeg = 30, kForwardDeg = 75, kRearDeg = 135;
constexpr double kGapRad = 0.03;

float Pi(double share) { return static_cast<float>(share * kPi); }

/// What is left over the caption, and its middle.
Box Above(const Paint& p, const Box& box, const std::string& caption) {
  const float y = box.high.y - p.fonts.small->FontSize;
  p.WriteCentred(p.fonts.small, {(box.low.x + box.high.x) / 2, y}, colour::kFaint, caption);
  return {box.low, {box.high.x, box.high.y - kCaption * p.scale}};
}

ImVec2 MiddleOf(const Box& box) {
  return {(box.low.x + box.high.x) / 2, (box.low.y + box.high.y) / 2};
}

/// A ring's piece between two angles, clockwise from the top.
void Arc(const Paint& p, ImVec2 centre, float radius, double from_rad, double to_rad, float width,
         ImU32 ink) {
  p.list->PathArcTo(centre, radius, static_cast<float>(from_rad - kPi / 2),
                    static_cast<float>(to_rad - kPi / 2), 32);
  p.list->PathStroke(ink, 0, width * p.scale);
}

/// A filled sector between two radii, clockwise from the top.
void Sector(const Paint& p, ImVec2 centre, float inner, float outer, double from_rad, double to_rad,
            ImU32 ink) {
  const float from = static_cast<float>(from_rad) - Pi(0.5),
              to = static_cast<float>(to_rad) - Pi(0.5);
  p.list->PathArcTo(centre, (inner + outer) / 2, from, to, 32);
  p.list->PathStroke(ink, 0, outer - inner);
}

/// The half circle in three sectors, and beside it where the character turns in place.
void DrawStickRegions(const Paint& p, ImVec2 centre, float radius,
                      const stream::InterfaceState& state) {
  const float s = p.scale;
  const int believed = state.turn.share >= 1 ? 1 : state.turn.share <= -1 ? -1 : 0;
  const auto tint = [&](Gait gait, int side) {
    return Faded(ColourOf(gait), state.gait == gait && believed == side ? kLit : kTint);
  };
  for (const int side : {-1, 0, 1}) {
    const double from_deg = side == 0 ? -kStraightDeg : side < 0 ? -kForwardDeg : kStraightDeg;
    const double to_deg = side == 0 ? kStraightDeg : side < 0 ? -kStraightDeg : kForwardDeg;
    const double from = DegreesToRadians(from_deg) + kGapRad;
    const double to = DegreesToRadians(to_deg) - kGapRad;
    Sector(p, centre, kCentreRadius * radius, kRunRadius * radius - s, from, to,
           tint(Gait::kWalk, side));
    Sector(p, centre, kRunRadius * radius + s, radius, from, to, tint(Gait::kRun, side));
    if (side == 0) continue;
    const double near = DegreesToRadians(kForwardDeg), far = DegreesToRadians(kRearDeg);
    Sector(p, centre, kCentreRadius * radius, radius, (side > 0 ? near : -far) + kGapRad,
           (side > 0 ? far : -near) - kGapRad, tint(Gait::kStep, side));
  }
}

}  // namespace

void DrawPhaseGauge(const Paint& p, const Box& box, const stream::InterfaceState& state) {
  const float s = p.scale;
  const bool known = state.phase_valid;
  const Box in = Above(
      p, box,
      known ? "phase " + scene::Fixed(RadiansToDegrees(std::fabs(state.phase_rad)), 0) + "\xc2\xb0"
            : std::string("phase"));
  const ImVec2 centre = MiddleOf(in);
  const float radius = std::min(in.width(), in.height()) / 2 - 4 * s;
  const double border = state.together_rad;
  const bool together = known && std::fabs(state.phase_rad) < border;
  Arc(p, centre, radius, -border, border, 5, Faded(ColourOf(Gait::kJump), together ? kLit : kTint));
  Arc(p, centre, radius, border, 2 * kPi - border, 5,
      Faded(ColourOf(Gait::kWalk), known && !together ? kLit : kTint));
  p.WriteCentred(p.fonts.tiny, {centre.x, in.low.y + 10 * s}, colour::kFaint, "jump");
  p.WriteCentred(p.fonts.tiny, {centre.x, in.high.y - 23 * s}, colour::kFaint, "walk");
  if (!known) return;
  const auto angle = static_cast<float>(state.phase_rad);
  const ImVec2 tip(centre.x + radius * std::sin(angle), centre.y - radius * std::cos(angle));
  p.Dot(tip, 4.5f, colour::kText);
}

void DrawFrequencyGauge(const Paint& p, const Box& box, const stream::InterfaceState& state) {
  const float s = p.scale;
  const Box in = Above(p, box, "frequency");
  const bool boards = state.interface == stream::UserInterface::kBoards;
  const double most_hz = boards ? kMostFootHz : kMostHz;
  const auto x_at = [&](double frequency_hz) {
    const double share = std::clamp(frequency_hz / most_hz, 0.0, 1.0);
    return in.low.x + static_cast<float>(share) * in.width();
  };
  const float top = in.low.y + 34 * s, bottom = top + 8 * s, border = x_at(state.border_hz);
  const bool run = state.gait == Gait::kRun, walk = state.gait == Gait::kWalk;
  p.list->AddRectFilled({in.low.x, top}, {border - s, bottom},
                        Faded(ColourOf(Gait::kWalk), walk ? kLit : kTint), 4 * s,
                        ImDrawFlags_RoundCornersLeft);
  p.list->AddRectFilled({border + s, top}, {in.high.x, bottom},
                        Faded(ColourOf(Gait::kRun), run ? kLit : kTint), 4 * s,
                        ImDrawFlags_RoundCornersRight);
  p.WriteCentred(p.fonts.tiny, {(in.low.x + border) / 2, bottom + 3 * s}, colour::kFaint, "walk");
  p.WriteCentred(p.fonts.tiny, {(border + in.high.x) / 2, bottom + 3 * s}, colour::kFaint, "run");
  const std::string value =
      state.frequency_valid ? scene::Fixed(state.frequency_hz, 2) + " Hz" : std::string("-");
  p.WriteCentred(p.fonts.strong, {(in.low.x + in.high.x) / 2, in.low.y + 4 * s}, colour::kText,
                 value);
  if (!state.frequency_valid) return;
  const float x = x_at(state.frequency_hz);
  p.list->AddRectFilled({x - 1.5f * s, top - 4 * s}, {x + 1.5f * s, bottom + 4 * s}, colour::kText,
                        1.5f * s);
}

void DrawForearmGauge(const Paint& p, const Box& box, const stream::InterfaceState& state) {
  const float s = p.scale;
  const Box in = Above(p, box,
                       state.frequency_valid ? "arms " + scene::Fixed(state.frequency_hz, 2) + " Hz"
                                             : std::string("arms"));
  const ImVec2 elbow(in.low.x + 0.34f * in.width(), in.low.y + 24 * s);
  const float length = 34 * s;
  const bool known = state.forearms.valid;
  const bool bent = known && state.forearms.elevation_rad > state.forearms.bent_rad;
  // Clockwise from the top, the front is at a right angle and a hanging forearm at two.
  const double border = kPi / 2 - state.forearms.bent_rad;
  Arc(p, elbow, length + 4 * s, kPi / 2 - 0.35, border, 5,
      Faded(ColourOf(Gait::kRun), bent ? kLit : kTint));
  Arc(p, elbow, length + 4 * s, border, kPi, 5,
      Faded(ColourOf(Gait::kWalk), known && !bent ? kLit : kTint));
  p.Write(p.fonts.tiny, {elbow.x + length - 2 * s, in.low.y}, colour::kFaint, "run");
  p.WriteRight(p.fonts.tiny, {elbow.x - 6 * s, in.high.y - 14 * s}, colour::kFaint, "walk");
  p.list->AddLine({elbow.x, in.low.y - 2 * s}, elbow, Faded(colour::kText, 0.6f), 5 * s);
  p.Dot(elbow, 3.5f, colour::kText);
  if (!known) return;
  const auto elevation = static_cast<float>(state.forearms.elevation_rad);
  const ImVec2 hand(elbow.x + length * std::cos(elevation), elbow.y - length * std::sin(elevation));
  p.list->AddLine(elbow, hand, colour::kText, 4 * s);
  p.Dot(hand, 4.5f, colour::kText);
}

void DrawStickGauge(const Paint& p, const Box& box, const stream::InterfaceState& state) {
  const float s = p.scale;
  const Box in = Above(p, box, "stick");
  const ImVec2 centre = MiddleOf(in);
  const float radius = std::min(in.width(), in.height()) / 2 - 2 * s;
  DrawStickRegions(p, centre, radius, state);
  p.list->AddCircle(centre, radius, colour::kGroove, 48, s);
  p.list->AddCircleFilled(centre, kCentreRadius * radius, colour::kGroove, 24);
  if (!state.stick.valid) return;
  const double reach = std::max(1.0, std::hypot(state.stick.x, state.stick.y));
  const ImVec2 tip(centre.x + radius * static_cast<float>(state.stick.x / reach),
                   centre.y - radius * static_cast<float>(state.stick.y / reach));
  p.list->AddLine(centre, tip, Faded(colour::kText, 0.5f), 2 * s);
  p.Dot(tip, 5, colour::kText);
}

void DrawButtonGauge(const Paint& p, const Box& box, const stream::InterfaceState& state) {
  const float s = p.scale;
  const Box in = Above(p, box, "jump");
  const bool pressed = state.activity == stream::Activity::kButton;
  const ImVec2 centre = MiddleOf(in);
  const ImU32 ink = ColourOf(Gait::kJump);
  p.list->AddCircleFilled(centre, 17 * s, pressed ? ink : Faded(ink, kTint), 32);
  p.WriteCentred(p.fonts.heading, {centre.x, centre.y - p.fonts.heading->FontSize / 2},
                 pressed ? IM_COL32(14, 20, 26, 255) : colour::kText, "A");
}

void DrawLoadGauge(const Paint& p, const Box& box, const stream::InterfaceState& state) {
  const float s = p.scale;
  const Box in = Above(p, box, "heels up: jump");
  const float foot = 20 * s, gap = 8 * s, middle = (in.low.x + in.high.x) / 2;
  for (const int side : {-1, 1}) {
    const float from = side < 0 ? middle - gap / 2 - foot : middle + gap / 2;
    const Box sole{{from, in.low.y + 2 * s}, {from + foot, in.high.y - 4 * s}};
    p.list->AddRectFilled(sole.low, sole.high, colour::kGroove, 9 * s);
    if (!state.load_valid) continue;
    const double share = side < 0 ? state.left_share : 1 - state.left_share;
    const float top = sole.high.y - static_cast<float>(std::clamp(share, 0.0, 1.0)) * sole.height();
    p.list->PushClipRect({sole.low.x, top}, sole.high, true);
    p.list->AddRectFilled(sole.low, sole.high, side < 0 ? colour::kAccent : colour::kSecond, 9 * s);
    p.list->PopClipRect();
  }
}

void DrawTurnGauge(const Paint& p, const Box& box, const stream::InterfaceState& state) {
  const float s = p.scale;
  const Box in = Above(p, box, std::string("turn by ") + stream::Name(state.turn.source));
  const float top = in.low.y + 34 * s, bottom = top + 8 * s, middle = (in.low.x + in.high.x) / 2;
  const float half = in.width() / 2, border = half / 2;
  const bool left = state.turn.share <= -1, right = state.turn.share >= 1;
  p.list->AddRectFilled({middle - border + s, top}, {middle + border - s, bottom}, colour::kGroove);
  p.list->AddRectFilled({in.low.x, top}, {middle - border - s, bottom},
                        Faded(colour::kSecond, left ? kLit : kTint), 4 * s,
                        ImDrawFlags_RoundCornersLeft);
  p.list->AddRectFilled({middle + border + s, top}, {in.high.x, bottom},
                        Faded(colour::kSecond, right ? kLit : kTint), 4 * s,
                        ImDrawFlags_RoundCornersRight);
  p.Write(p.fonts.tiny, {in.low.x, bottom + 3 * s}, colour::kFaint, "left");
  p.WriteRight(p.fonts.tiny, {in.high.x, bottom + 3 * s}, colour::kFaint, "right");
  p.WriteCentred(p.fonts.strong, {middle, in.low.y + 4 * s}, colour::kText,
                 left    ? "left"
                 : right ? "right"
                         : "straight");
  if (!state.turn.valid) return;
  const auto share = static_cast<float>(std::clamp(state.turn.share, -2.0, 2.0) / 2);
  p.Dot({middle + share * half, (top + bottom) / 2}, 5, colour::kText);
}

}  // namespace footing::render
