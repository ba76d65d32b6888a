#include "clients/view/render/calibration_panel.h"

#include <algorithm>
#include <string>
#include <vector>

namespace footing::render {
namespace {

constexpr float kWidestText = 560, kMarginOfBoth = 28, kGapOfLines = 4, kRestBar = 16;

struct InkedLine {
  ImFont* font = nullptr;
  ImU32 ink = 0;
  std::string text;
};

ImU32 TitleInk(const scene::Calibration& calibration) {
  if (!calibration.result) return colour::kText;
  return calibration.result->passed ? colour::kGood : colour::kBad;
}

std::vector<InkedLine> CalibrationLines(const Paint& p, const scene::Calibration& calibration,
                                        float width) {
  std::vector<InkedLine> lines;
  const auto add = [&](ImFont* font, ImU32 ink, const std::string& text) {
    for (std::string& line : p.Wrapped(font, text, width))
      lines.push_back({font, ink, std::move(line)});
  };
  add(p.fonts.small, colour::kAccent, scene::CalibrationProgress(calibration));
  add(p.fonts.strong, TitleInk(calibration), scene::CalibrationTitle(calibration));
  const bool is_bad = calibration.result && !calibration.result->passed;
  add(p.fonts.small, is_bad ? colour::kWarning : colour::kText,
      scene::CalibrationDetail(calibration));
  add(p.fonts.small, colour::kFaint,
      calibration.result ? "C begins again, X closes this screen" : "X ends it; nothing is stored");
  return lines;
}

}  // namespace

void DrawCalibrationPanel(const Paint& p, const scene::Calibration& calibration, const Box& space) {
  const float s = p.scale;
  const float width = std::min(space.width(), kWidestText * s);
  const auto lines = CalibrationLines(p, calibration, width - kMarginOfBoth * s);
  float height = kMarginOfBoth * s + (calibration.result ? 0 : kRestBar * s);
  for (const InkedLine& line : lines) height += line.font->FontSize + kGapOfLines * s;
  const float middle = (space.low.x + space.high.x) / 2;
  const float top = std::max(space.low.y, space.high.y - height);
  const Box in = p.Panel({{middle - width / 2, top}, {middle + width / 2, space.high.y}});
  float y = in.low.y;
  for (const InkedLine& line : lines) {
    p.Write(line.font, {in.low.x, y}, line.ink, line.text);
    y += line.font->FontSize + kGapOfLines * s;
  }
  const double share = calibration.marks && !calibration.result ? calibration.marks->rest_share : 0;
  if (!calibration.result)
    p.Bar({{in.low.x, in.high.y - 8 * s}, {in.high.x, in.high.y}}, static_cast<float>(share),
          colour::kGood);
}

}  // namespace footing::render
