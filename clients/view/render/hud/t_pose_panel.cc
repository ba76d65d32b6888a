#include "clients/view/render/hud/t_pose_panel.h"

#include <algorithm>
#include <cmath>

#include "clients/view/scene/words.h"
#include "common/units/units.h"

namespace footing::render {
namespace {

constexpr double kTPoseS = 5;
constexpr float kBottom = 18;

void DrawRing(const Paint& p, ImVec2 centre, float radius, double progress) {
  const float s = p.scale;
  const auto start = static_cast<float>(-kPi / 2);
  const auto end = start + static_cast<float>(2 * kPi * std::clamp(progress, 0.0, 1.0));
  p.list->AddCircle(centre, radius, colour::kGroove, 48, 7 * s);
  if (progress > 0.002) {
    p.list->PathArcTo(centre, radius, start, end, 48);
    p.list->PathStroke(colour::kGood, 0, 7 * s);
  }
  const std::string left = scene::Fixed(std::ceil(kTPoseS * (1 - progress)), 0);
  p.WriteCentred(p.fonts.heading, {centre.x, centre.y - 13 * s}, colour::kText, left);
}

void DrawWizard(const Paint& p, const scene::Model& model, const scene::BodyState& body,
                ImVec2 size) {
  const float s = p.scale;
  const float width = std::max(420 * s, p.WidthOf(p.fonts.heading, body.note) + 132 * s);
  const ImVec2 low((size.x - width) / 2, size.y - (kBottom + 96) * s);
  const Box in = p.Panel({low, {low.x + width, low.y + 96 * s}});
  DrawRing(p, {in.low.x + 34 * s, in.low.y + 34 * s}, 30 * s, body.calibration_progress);
  const float x = in.low.x + 84 * s;
  p.Write(p.fonts.small, {x, in.low.y + 2 * s}, colour::kFaint,
          "T-pose   " + (body.subject.empty() ? std::string("of whoever stands there")
                                              : "of " + body.subject));
  const scene::Stance stance = scene::StanceOf(model);
  if (stance.valid) {
    p.WriteRight(p.fonts.strong, {in.high.x, in.low.y}, colour::kGood,
                 scene::Fixed(NewtonsToKilograms(stance.total_n), 1) + " kg");
  }
  p.Write(p.fonts.heading, {x, in.low.y + 20 * s}, colour::kText, body.note);
  p.Write(p.fonts.small, {x, in.low.y + 50 * s}, colour::kFaint,
          "Stand as the blue figure does, for five seconds.");
}

}  // namespace

void DrawTPosePanel(const Paint& p, const scene::Model& model, const scene::CharacterPose& pose,
                    ImVec2 size) {
  const scene::BodyState& body = *pose.body;
  if (!body.calibrated) return DrawWizard(p, model, body, size);
  if (body.note.empty()) return;
  const float s = p.scale;
  const float room = size.x - 2 * 330 * s;
  const std::string note = p.Fitting(p.fonts.text, body.note, room);
  const float width = p.WidthOf(p.fonts.text, note) + 32 * s;
  const ImVec2 low((size.x - width) / 2, size.y - (kBottom + 32) * s);
  p.list->AddRectFilled(low, {low.x + width, low.y + 32 * s}, colour::kPanel, 16 * s);
  p.WriteCentred(p.fonts.text, {size.x / 2, low.y + 7 * s}, colour::kWarning, note);
}

}  // namespace footing::render
