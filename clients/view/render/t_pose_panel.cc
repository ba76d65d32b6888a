#include "clients/view/render/t_pose_panel.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "clients/view/scene/words.h"
#include "common/base/units.h"

namespace footing::render {
namespace {

constexpr double kTPoseS = 5;

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

/// Lines of one font and colour.
struct Paragraph {
  ImFont* font = nullptr;
  ImU32 ink = 0;
  std::vector<std::string> lines;
};

float ParagraphHeight(const Paragraph& paragraph, float scale) {
  return static_cast<float>(paragraph.lines.size()) * (paragraph.font->FontSize + 4 * scale);
}

std::vector<Paragraph> TextOf(const Paint& p, const scene::Model& model,
                              const scene::BodyState& body, float width) {
  const bool wide = width > 300 * p.scale;
  const scene::Stance stance = scene::StanceOf(model);
  std::string who = body.subject.empty() ? "T-pose" : "T-pose of " + body.subject;
  if (stance.valid) who += "   " + scene::Fixed(NewtonsToKilograms(stance.total_n), 1) + " kg";
  const auto paragraph = [&](ImFont* font, ImU32 ink, const std::string& text) {
    return Paragraph{font, ink, p.Wrapped(font, text, width)};
  };
  return {
      paragraph(p.fonts.small, stance.valid ? colour::kGood : colour::kFaint, who),
      paragraph(wide ? p.fonts.heading : p.fonts.strong, colour::kText, body.note),
      paragraph(p.fonts.small, colour::kFaint, "Stand as the blue figure does, for five seconds.")};
}

void DrawWizard(const Paint& p, const scene::Model& model, const scene::BodyState& body,
                const Box& space) {
  const float s = p.scale, ring = 84 * s, margins = 28 * s;
  const bool beside = space.width() > 380 * s;  // The ring beside the text, else above it.
  const float most = space.width() - margins - (beside ? ring : 0);
  const auto text = TextOf(p, model, body, most);
  float text_width = beside ? 330 * s : 0, text_height = 0;
  for (const Paragraph& paragraph : text) {
    text_height += ParagraphHeight(paragraph, s);
    for (const std::string& line : paragraph.lines) {
      text_width = std::max(text_width, p.WidthOf(paragraph.font, line));
    }
  }
  text_width = std::min(text_width, most);
  const float width = margins + text_width + (beside ? ring : 0);
  const float height = margins + (beside ? std::max(text_height, 68 * s) : text_height + 76 * s);
  const float middle = (space.low.x + space.high.x) / 2;
  const Box in =
      p.Panel({{middle - width / 2, space.high.y - height}, {middle + width / 2, space.high.y}});
  DrawRing(p, {beside ? in.low.x + 34 * s : middle, in.low.y + 34 * s}, 30 * s,
           body.calibration_progress);
  const float x = beside ? in.low.x + ring : in.low.x;
  float y = beside ? in.low.y : in.low.y + 76 * s;
  for (const Paragraph& paragraph : text) {
    for (const std::string& line : paragraph.lines) {
      p.Write(paragraph.font, {x, y}, paragraph.ink, line);
      y += paragraph.font->FontSize + 4 * s;
    }
  }
}

}  // namespace

void DrawTPosePanel(const Paint& p, const scene::Model& model, const scene::CharacterPose& pose,
                    const Box& space) {
  const scene::BodyState& body = *pose.body;
  if (!body.calibrated) return DrawWizard(p, model, body, space);
  if (body.note.empty()) return;
  const float s = p.scale, line_height = 19 * s;
  const auto lines = p.Wrapped(p.fonts.text, body.note, space.width() - 32 * s);
  float width = 0;
  for (const std::string& line : lines) width = std::max(width, p.WidthOf(p.fonts.text, line));
  const float middle = (space.low.x + space.high.x) / 2;
  const float height = line_height * static_cast<float>(lines.size()) + 12 * s;
  float y = space.high.y - height;
  p.list->AddRectFilled({middle - width / 2 - 16 * s, y}, {middle + width / 2 + 16 * s, y + height},
                        colour::kPanel, 16 * s);
  y += 6 * s;
  for (const std::string& line : lines) {
    p.WriteCentred(p.fonts.text, {middle, y}, colour::kWarning, line);
    y += line_height;
  }
}

}  // namespace footing::render
