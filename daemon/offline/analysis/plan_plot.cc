#include "daemon/offline/analysis/plan_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "daemon/offline/analysis/svg.h"

namespace footing::plot {
namespace {

constexpr double kPlanWidth = 900, kPlanMargin = 16, kPlanTop = 34, kNameHeight = 20,
                 kKeyHeight = 22, kScaleM = 10;
/// Pixels a metre: four tracks of 40 m beside each other.
constexpr double kPlanScale = 5;

struct PlanExtent {
  double left = std::numeric_limits<double>::infinity(), low = left, right = -left, high = -left;

  double width() const { return right > left ? kPlanScale * (right - left) : 0; }
  double height() const { return high > low ? kPlanScale * (high - low) : 0; }
};

bool IsFiniteShape(const PlanShape& shape) {
  return std::all_of(shape.corners.begin(), shape.corners.end(), [](const auto& corner) {
    return std::isfinite(corner[0]) && std::isfinite(corner[1]);
  });
}

PlanExtent ExtentOf(const PlanPanel& panel) {
  PlanExtent extent;
  for (const PlanShape& shape : panel.shapes) {
    if (!IsFiniteShape(shape)) continue;
    for (const auto& [x, y] : shape.corners) {
      extent.left = std::min(extent.left, x);
      extent.right = std::max(extent.right, x);
      extent.low = std::min(extent.low, y);
      extent.high = std::max(extent.high, y);
    }
  }
  return extent;
}

/// The panel with its upper left corner at a point.
std::string DrawPanel(const PlanPanel& panel, const PlanExtent& extent, double x, double y) {
  std::string svg = Label(x, y + 13, "start", panel.name, "font-weight='bold'");
  for (const PlanShape& shape : panel.shapes) {
    if (!IsFiniteShape(shape) || shape.corners.size() < 2) continue;
    std::string points;
    for (const auto& corner : shape.corners) {
      points += Number(x + kPlanScale * (corner[0] - extent.left)) + "," +
                Number(y + kNameHeight + kPlanScale * (extent.high - corner[1])) + " ";
    }
    const bool line = shape.corners.size() == 2;
    svg += "<polygon points='" + points + "' fill='" + (line ? "none" : shape.colour) +
           "' stroke='" + shape.colour + "' stroke-width='" + (line ? "2.5" : "0.5") + "'/>\n";
  }
  return svg;
}

std::string DrawKeys(const std::vector<PlanKey>& keys, double y) {
  std::string svg = Line(kPlanMargin, y + 8, kPlanMargin + kPlanScale * kScaleM, y + 8, "#222",
                         "stroke-width='2'");
  double x = kPlanMargin + kPlanScale * kScaleM + 8;
  svg += Label(x, y + 12, "start", Number(kScaleM) + " m");
  x += 50;
  for (const PlanKey& key : keys) {
    svg += "<rect x='" + Number(x) + "' y='" + Number(y + 2) + "' width='14' height='12' fill='" +
           key.colour + "' stroke='#222' stroke-width='0.4'/>\n";
    svg += Label(x + 19, y + 12, "start", key.meaning);
    x += 34 + 6.5 * static_cast<double>(key.meaning.size());
  }
  return svg;
}

}  // namespace

std::string PlanPlot(const std::string& title, const std::vector<PlanPanel>& panels,
                     const std::vector<PlanKey>& keys) {
  std::string drawn;
  double x = kPlanMargin, y = kPlanTop, row_height = 0;
  for (const PlanPanel& panel : panels) {
    const PlanExtent extent = ExtentOf(panel);
    const double width = std::max(extent.width(), 7.0 * static_cast<double>(panel.name.size()));
    if (x > kPlanMargin && x + width > kPlanWidth - kPlanMargin) {
      x = kPlanMargin;
      y += row_height + kPlanMargin;
      row_height = 0;
    }
    drawn += DrawPanel(panel, extent, x, y);
    x += width + 2 * kPlanMargin;
    row_height = std::max(row_height, kNameHeight + extent.height());
  }
  y += row_height + kPlanMargin;
  return Open(kPlanWidth, y + kKeyHeight) +
         Label(kPlanWidth / 2, 20, "middle", title, "font-size='14'") + drawn + DrawKeys(keys, y) +
         "</svg>\n";
}

}  // namespace footing::plot
