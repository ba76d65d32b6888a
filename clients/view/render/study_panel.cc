#include "clients/view/render/study_panel.h"

#include <algorithm>
#include <string>
#include <vector>

#include "clients/view/scene/study_text.h"
#include "common/base/units.h"

namespace footing::render {
namespace {

constexpr float kWidestPanel = 460;
constexpr float kBothMargins = 28;  // Of a panel, both sides.
constexpr float kBetweenLines = 3;

struct Line {
  ImFont* font = nullptr;
  ImU32 ink = 0;
  std::string text;
};

}  // namespace

void DrawStudyPanel(const Paint& p, const scene::Model& model, std::int64_t now_ns, Box& space) {
  const stream::StudyState& study = model.study.state;
  if (!scene::ShowsStudy(study)) return;
  const float s = p.scale;
  const float width = std::min(space.width(), kWidestPanel * s);
  const float inner = width - kBothMargins * s;
  const std::string clock =
      scene::StudyClock(study, NanosecondsToSeconds(now_ns - model.study.received_ns));
  const float clock_width = clock.empty() ? 0 : p.WidthOf(p.fonts.heading, clock) + 8 * s;
  std::vector<Line> lines;
  const auto add = [&](ImFont* font, ImU32 ink, const std::string& text, float wrap) {
    for (std::string& line : p.Wrapped(font, text, wrap))
      lines.push_back({font, ink, std::move(line)});
  };
  add(p.fonts.strong, colour::kText, scene::StudyTitle(study), inner - clock_width);
  add(p.fonts.strong, colour::kAccent, study.doing, inner - clock_width);
  add(p.fonts.small, colour::kText, scene::StudyKeys(study), inner);
  add(p.fonts.small, colour::kFaint, scene::StudyNext(study), inner);
  float height = kBothMargins * s;
  for (const Line& line : lines) height += line.font->FontSize + kBetweenLines * s;
  if (height > space.height()) return;
  const float middle = (space.low.x + space.high.x) / 2;
  const Box in =
      p.Panel({{middle - width / 2, space.low.y}, {middle + width / 2, space.low.y + height}});
  p.WriteRight(p.fonts.heading, {in.high.x, in.low.y}, colour::kText, clock);
  float y = in.low.y;
  for (const Line& line : lines) {
    p.Write(line.font, {in.low.x, y}, line.ink, line.text);
    y += line.font->FontSize + kBetweenLines * s;
  }
  space.low.y += height + 6 * s;
}

}  // namespace footing::render
