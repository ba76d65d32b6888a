#include "clients/view/render/character_panel.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "clients/view/scene/words.h"
#include "common/base/units.h"

namespace footing::render {
namespace {

constexpr float kCharacterPanelHeight = 196;
constexpr float kCharacterPhaseHeight = 70;
constexpr double kFullSpeedMps = 4;
constexpr double kFullTurnRad = DegreesToRadians(15);
constexpr std::int64_t kPhaseStripNs = 4'000'000'000;

/// An arc like a steering wheel's: the needle is the commanded turn a step, left to the left.
void DrawTurn(const Paint& p, ImVec2 centre, float radius, double turn_rad) {
  const auto angle_at = [](double turn) {
    const double share = std::clamp(turn / kFullTurnRad, -1.0, 1.0);
    return static_cast<float>(-kPi / 2 - share * 1.1);
  };
  p.list->PathArcTo(centre, radius, static_cast<float>(-kPi / 2 - 1.1),
                    static_cast<float>(-kPi / 2 + 1.1), 24);
  p.list->PathStroke(colour::kGroove, 0, 4 * p.scale);
  const float needle = angle_at(turn_rad);
  if (std::abs(turn_rad) > 1e-3) {
    const float straight = angle_at(0);
    p.list->PathArcTo(centre, radius, std::min(needle, straight), std::max(needle, straight), 16);
    p.list->PathStroke(colour::kSecond, 0, 4 * p.scale);
  }
  const ImVec2 tip(centre.x + radius * std::cos(needle), centre.y + radius * std::sin(needle));
  p.Dot(tip, 5, colour::kText);
  const std::string text = scene::Fixed(std::abs(RadiansToDegrees(turn_rad)), 0) + "\xc2\xb0/step";
  p.WriteCentred(p.fonts.small, {centre.x, centre.y - 12 * p.scale}, colour::kFaint, text);
}

void DrawSpeed(const Paint& p, const Box& box, const stream::GaitState& gait, ImU32 ink) {
  const float s = p.scale;
  p.Write(p.fonts.strong, box.low, colour::kText, scene::Fixed(gait.speed_mps, 2) + " m/s");
  p.WriteRight(p.fonts.small, {box.high.x, box.low.y + 2 * s}, colour::kFaint,
               "commanded " + scene::Fixed(gait.commanded_speed_mps, 2));
  const Box bar{{box.low.x, box.low.y + 22 * s}, {box.high.x, box.low.y + 29 * s}};
  p.Bar(bar, static_cast<float>(gait.speed_mps / kFullSpeedMps), ink);
  const auto share =
      static_cast<float>(std::clamp(gait.commanded_speed_mps / kFullSpeedMps, 0.0, 1.0));
  const float mark = bar.low.x + share * bar.width();
  p.list->AddRectFilled({mark - 1.5f * s, bar.low.y - 4 * s}, {mark + 1.5f * s, bar.high.y + 4 * s},
                        colour::kText, 1.5f * s);
}

void DrawCounts(const Paint& p, const Box& box, const stream::GaitState& gait) {
  const float s = p.scale;
  const float third = box.width() / 3;
  const ImU32 fall_ink = gait.falls > 0 ? colour::kWarning : colour::kText;
  const auto write = [&](int column, const char* name, const std::string& value, ImU32 ink) {
    const float x = box.low.x + static_cast<float>(column) * third;
    p.Write(p.fonts.small, {x, box.low.y}, colour::kFaint, name);
    p.Write(p.fonts.strong, {x, box.low.y + 15 * s}, ink, value);
  };
  write(0, "distance", scene::Fixed(gait.distance_m, 1) + " m", colour::kText);
  write(1, "falls", std::to_string(gait.falls), fall_ink);
  if (gait.gait == stream::Gait::kJump || gait.commanded_gait == stream::Gait::kJump) {
    write(2, "jump height", scene::Fixed(100 * gait.commanded_height_m, 0) + " cm", colour::kText);
  } else {
    write(2, "steps", std::to_string(gait.steps), colour::kText);
  }
}

/// The states of the gait controller: labels, the present one lit, and their last 4 s as a band.
void DrawPhases(const Paint& p, const Box& box, const scene::Model& model,
                const scene::CharacterPose& pose, std::int64_t now_ns) {
  static constexpr std::array<ImU32, 4> kInks{colour::kAccent, colour::kGood, colour::kSecond,
                                              colour::kThird};
  const float s = p.scale;
  const auto ink_of = [&model](const std::string& phase) {
    const auto at = std::find(model.phases.begin(), model.phases.end(), phase);
    return kInks[static_cast<std::size_t>(at - model.phases.begin()) % kInks.size()];
  };
  float x = box.low.x, y = box.low.y;
  for (const std::string& phase : model.phases) {
    const bool now = phase == pose.phase;
    const ImU32 ink = now ? IM_COL32(14, 20, 26, 255) : colour::kFaint;
    const std::string name = phase.empty() ? "-" : scene::PhaseTitle(phase);
    if (x + p.WidthOf(p.fonts.small, name) + 14 * s > box.high.x) {
      x = box.low.x;
      y += 22 * s;
    }
    if (y > box.low.y + 22 * s) break;  // Two rows hold every gait's states.
    x += p.Label({x, y}, now ? ink_of(phase) : colour::kGroove, ink, name) + 5 * s;
  }
  const float top = box.low.y + 47 * s, bottom = box.low.y + 55 * s;
  const std::int64_t shown_ns = scene::ShownTime(model.playout.newest_ns(), now_ns);
  const auto x_at = [&](std::int64_t time_ns) {
    const double age = static_cast<double>(shown_ns - time_ns) / static_cast<double>(kPhaseStripNs);
    return box.high.x - static_cast<float>(std::clamp(age, 0.0, 1.0)) * box.width();
  };
  for (std::size_t i = 0; i < model.phase_spans.size(); ++i) {
    const scene::PhaseSpan& span = model.phase_spans[i];
    const bool last = i + 1 == model.phase_spans.size();
    const float from = x_at(span.start_ns);
    const float to = last ? box.high.x : x_at(model.phase_spans[i + 1].start_ns);
    if (to - from < 0.5f) continue;
    p.list->AddRectFilled({from, top}, {to - 1, bottom}, Faded(ink_of(span.phase), 0.85f));
  }
}

}  // namespace

PanelHeight CharacterPanelHeight(bool phases) {
  return {kCharacterPanelHeight, kCharacterPanelHeight + (phases ? kCharacterPhaseHeight : 0)};
}

void DrawCharacterPanel(const Paint& p, const Box& box, const scene::Model& model,
                        const scene::CharacterPose& pose, std::int64_t now_ns) {
  const float s = p.scale;
  const stream::GaitState& gait = pose.gait;
  const bool phases = box.height() > (kCharacterPanelHeight + kCharacterPhaseHeight - 1) * s;
  const float height = (kCharacterPanelHeight + (phases ? kCharacterPhaseHeight : 0)) * s;
  const Box in = p.Panel({box.low, {box.high.x, box.low.y + height}});
  const ImU32 ink = ColourOf(gait.gait);
  p.Write(p.fonts.title, {in.low.x, in.low.y - 8 * s}, ink, scene::GaitTitle(gait.gait));
  DrawTurn(p, {in.high.x - 44 * s, in.low.y + 42 * s}, 38 * s, gait.commanded_turn_rad);

  const float row = in.low.y + 46 * s;
  if (gait.pending) {
    p.Label({in.low.x, row}, colour::kWarning, IM_COL32(30, 20, 0, 255),
            "next: " + scene::GaitTitle(gait.commanded_gait) + ", waiting for its moment");
  } else if (!gait.commanded_by_stream) {
    p.Label({in.low.x, row}, colour::kGroove, colour::kWarning, "no sensor input");
  } else {
    const bool missing = pose.interface.activity == stream::Activity::kAbsent;
    p.Label({in.low.x, row}, colour::kGroove, missing ? colour::kWarning : colour::kFaint,
            missing ? "devices are missing" : "follows the person");
  }
  DrawSpeed(p, {{in.low.x, in.low.y + 78 * s}, {in.high.x, in.low.y + 110 * s}}, gait, ink);
  DrawCounts(p, {{in.low.x, in.low.y + 128 * s}, {in.high.x, in.high.y}}, gait);
  if (phases) {
    DrawPhases(p, {{in.low.x, in.low.y + 178 * s}, {in.high.x, in.high.y}}, model, pose, now_ns);
  }
}

}  // namespace footing::render
