#include "clients/view/render/interface_panel.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "clients/view/render/interface_gauges.h"
#include "clients/view/scene/interface_text.h"
#include "clients/view/scene/words.h"

namespace footing::render {
namespace {

using stream::Gait;
using stream::UserInterface;

constexpr float kInterfacePanelHeight = 152;
constexpr float kGaugesTop = 22, kGaugesHeight = 76;
constexpr float kGaugeGap = 12;
constexpr float kCommandRow = 24, kProblemRow = 17, kAboveProblem = 8;
constexpr float kBelowText = 4;       // Of a row, under its letters.
constexpr float kLettersOfLine = 34;  // That surely fit into the narrowest panel.
constexpr ImU32 kLetters = IM_COL32(14, 20, 26, 255);

/// The gauge of the motion, and that of its pace; one over both columns where it says both.
void DrawMotion(const Paint& p, const Box& left, const Box& middle,
                const stream::InterfaceState& state) {
  switch (state.interface) {
    case UserInterface::kUnspecified:
      return;
    case UserInterface::kWrist:
    case UserInterface::kLeg:
      DrawPhaseGauge(p, left, state);
      DrawFrequencyGauge(p, middle, state);
      return;
    case UserInterface::kArm:
      DrawPhaseGauge(p, left, state);
      DrawForearmGauge(p, middle, state);
      return;
    case UserInterface::kJoystick:
      DrawStickGauge(p, left, state);
      DrawButtonGauge(p, middle, state);
      return;
    case UserInterface::kBoards:
      DrawLoadGauge(p, left, state);
      DrawFrequencyGauge(p, middle, state);
      return;
  }
}

/// The commanded gait, and one that is seen and has not lasted long enough, filling up.
void DrawCommand(const Paint& p, ImVec2 at, const Box& in, const stream::InterfaceState& state) {
  const float s = p.scale;
  float x = at.x + p.Label(at, ColourOf(state.gait), kLetters, scene::GaitTitle(state.gait));
  if (state.next_gait != Gait::kUnspecified) {
    const std::string title = scene::GaitTitle(state.next_gait);
    x += 8 * s;
    const float from = x;
    x += p.Label({x, at.y}, colour::kGroove, ColourOf(state.next_gait), title);
    p.Bar({{from, at.y + 20 * s}, {x, at.y + 23 * s}}, static_cast<float>(state.next_share),
          ColourOf(state.next_gait));
  }
  const std::string problem = scene::ProblemText(state);
  if (problem.empty()) return;
  // Under the command in as many lines as it needs; where the panel is too low, beside it.
  const auto lines = p.Wrapped(p.fonts.small, problem, in.high.x - at.x);
  const float first = at.y + kCommandRow * s, row = kProblemRow * s;
  if (first + row * static_cast<float>(lines.size()) > in.high.y + kBelowText * s) {
    p.Write(p.fonts.small, {x + 10 * s, at.y + 2.5f * s}, colour::kWarning,
            p.Fitting(p.fonts.small, problem, in.high.x - x - 10 * s));
    return;
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    p.Write(p.fonts.small, {at.x, first + row * static_cast<float>(i)}, colour::kWarning, lines[i]);
  }
}

}  // namespace

PanelHeight InterfacePanelHeight(const stream::InterfaceState& state) {
  if (state.interface == UserInterface::kUnspecified) return {};
  const auto letters = static_cast<float>(scene::ProblemText(state).size());
  const float lines = std::ceil(letters / kLettersOfLine);
  return {kInterfacePanelHeight,
          kInterfacePanelHeight + (lines > 0 ? kAboveProblem : 0) + kProblemRow * lines};
}

void DrawInterfacePanel(const Paint& p, const Box& box, const stream::InterfaceState& state) {
  const float s = p.scale;
  const Box in = p.Panel(box);
  const float name = p.Write(p.fonts.strong, in.low, colour::kText, stream::Name(state.interface));
  const float space = in.width() - name - 10 * s;
  p.WriteRight(p.fonts.small, {in.high.x, in.low.y + 2 * s}, colour::kFaint,
               p.Fitting(p.fonts.small, scene::ActivityText(state), space));
  const float width = (in.width() - 2 * kGaugeGap * s) / 3;
  const auto column = [&](int number) {
    const float x = in.low.x + static_cast<float>(number) * (width + kGaugeGap * s);
    const float top = in.low.y + kGaugesTop * s;
    return Box{{x, top}, {x + width, top + kGaugesHeight * s}};
  };
  DrawMotion(p, column(0), column(1), state);
  DrawTurnGauge(p, column(2), state);
  DrawCommand(p, {in.low.x, in.low.y + (kGaugesTop + kGaugesHeight + 9) * s}, in, state);
}

}  // namespace footing::render
