#include "daemon/offline/analysis/stick_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "daemon/offline/analysis/svg.h"

namespace footing::plot {
namespace {

constexpr double kPanelWidth = 240, kPanelHeight = 380, kPanelTop = 60, kPanelBottom = 40,
                 kMargin = 12;

bool IsShown(const std::array<double, 4>& stick) {
  return std::all_of(stick.begin(), stick.end(), [](double value) { return std::isfinite(value); });
}

struct Extent {
  double left = std::numeric_limits<double>::infinity(), right = -left, top = 0;

  void Take(const Sticks& sticks) {
    for (const auto& stick : sticks) {
      if (!IsShown(stick)) continue;
      left = std::min({left, stick[0], stick[2]});
      right = std::max({right, stick[0], stick[2]});
      top = std::max({top, stick[1], stick[3]});
    }
  }
  double width() const { return right > left ? right - left : 1; }
  double middle() const { return right > left ? (left + right) / 2 : 0; }
};

}  // namespace

std::string StickPlot(const std::string& title, const std::vector<Panel>& panels) {
  std::vector<Extent> extents(panels.size());
  double scale = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < panels.size(); ++i) {
    extents[i].Take(panels[i].reference);
    extents[i].Take(panels[i].figure);
    scale = std::min({scale, (kPanelWidth - 2 * kMargin) / extents[i].width(),
                      (kPanelHeight - kPanelTop - kPanelBottom) / std::max(extents[i].top, 1e-9)});
  }
  const double width = kPanelWidth * static_cast<double>(std::max<std::size_t>(panels.size(), 1));
  const double ground = kPanelHeight - kPanelBottom;
  std::string svg = Open(width, kPanelHeight);
  svg += Label(width / 2, 22, "middle", title, "font-size='14'");
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const double middle = kPanelWidth * (static_cast<double>(i) + 0.5);
    // A group's opacity: lines that cross do not get darker there.
    const auto draw = [&](const Sticks& sticks, const std::string& colour, const char* more) {
      svg += std::string("<g ") + more + " stroke-linecap='round'>\n";
      for (const auto& stick : sticks) {
        if (!IsShown(stick)) continue;
        const auto at_x = [&](double x) { return middle + scale * (x - extents[i].middle()); };
        const auto at_y = [&](double y) { return ground - scale * y; };
        svg += Line(at_x(stick[0]), at_y(stick[1]), at_x(stick[2]), at_y(stick[3]), colour);
      }
      svg += "</g>\n";
    };
    svg += Line(middle - kPanelWidth / 2 + kMargin, ground, middle + kPanelWidth / 2 - kMargin,
                ground, "#aaa");
    draw(panels[i].reference, kReferenceColour, "stroke-width='7' opacity='0.22'");
    draw(panels[i].figure, kColours[0], "stroke-width='3'");
    svg += Label(middle, kPanelHeight - 14, "middle", panels[i].name);
  }
  return svg + "</svg>\n";
}

}  // namespace footing::plot
