#include "common/plot/line_plot.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

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

std::string Escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    escaped += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  }
  return escaped;
}

std::string Number(double value) {
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 6);
  return {text.data(), end.ptr};
}

std::string Open(double width, double height) {
  return "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 " + Number(width) + " " +
         Number(height) + "' font-family='sans-serif' font-size='12' fill='#222'>\n" +
         "<rect width='100%' height='100%' fill='white'/>\n";
}

std::string Label(double x, double y, const std::string& anchor, const std::string& text,
                  const std::string& more) {
  return "<text x='" + Number(x) + "' y='" + Number(y) + "' text-anchor='" + anchor + "' " + more +
         ">" + Escaped(text) + "</text>\n";
}

std::string Line(double x1, double y1, double x2, double y2, const std::string& colour,
                 const std::string& more) {
  return "<line x1='" + Number(x1) + "' y1='" + Number(y1) + "' x2='" + Number(x2) + "' y2='" +
         Number(y2) + "' stroke='" + colour + "'" + (more.empty() ? "" : " " + more) + "/>\n";
}

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

namespace {

constexpr double kWidth = 640, kHeight = 360, kLeft = 60, kRight = 20, kTop = 40, kBottom = 50;
constexpr double kLegendWidth = 150;  // Beside the curves.

/// 1, 2 or 5 times a power of ten: about five marks over `length`.
double MarkSpacing(double length) {
  const double rough = length / 5;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) return factor * power;
  }
  return 10 * power;
}

struct Scale {
  double least, largest, spacing = 1;

  explicit Scale(Axes axes)
      : least(axes == Axes::kFromZero ? 0 : std::numeric_limits<double>::infinity()),
        largest(axes == Axes::kFromZero ? 0 : -std::numeric_limits<double>::infinity()) {}

  void Take(double value) {
    least = std::min(least, value);
    largest = std::max(largest, value);
  }
  /// Numbers below zero have no place on an axis from zero.
  void Close(Axes axes) {
    if (axes == Axes::kFromZero) least = 0;
    if (!(largest > least)) {
      if (!std::isfinite(least)) least = 0;
      largest = least + 1;
    }
    spacing = MarkSpacing(largest - least);
  }
  /// From mark to mark.
  void Widen() {
    least = spacing * std::floor(least / spacing + 1e-9);
    largest = spacing * std::ceil(largest / spacing - 1e-9);
  }
  /// Marks are counted, so that none is a little beside zero.
  int first_mark() const { return static_cast<int>(std::ceil(least / spacing - 1e-9)); }
  int last_mark() const { return static_cast<int>(std::floor(largest / spacing + 1e-9)); }
  double Share(double value) const { return (value - least) / (largest - least); }
};

bool IsShown(const std::pair<double, double>& point) {
  return std::isfinite(point.first) && std::isfinite(point.second);
}

}  // namespace

std::string LinePlot(const std::string& title, const std::string& x_label,
                     const std::string& y_label, const std::vector<Curve>& curves, Axes axes) {
  Scale x(axes), y(axes);
  for (const Curve& curve : curves) {
    for (const auto& point : curve.points) {
      if (!IsShown(point)) continue;
      x.Take(point.first);
      y.Take(point.second);
    }
  }
  x.Close(axes);
  y.Close(axes);
  if (axes == Axes::kFromZero) x.Widen();
  y.Widen();
  const bool beside = axes == Axes::kFitted;
  const double width = kWidth + (beside ? kLegendWidth : 0);
  const double bottom = kHeight - kBottom, right = kWidth - kRight;
  const auto at_x = [&](double value) { return kLeft + x.Share(value) * (right - kLeft); };
  const auto at_y = [&](double value) { return bottom - y.Share(value) * (bottom - kTop); };

  std::string svg = Open(width, kHeight);
  svg += Label(width / 2, 22, "middle", title, "font-size='14'");
  svg += Label((kLeft + right) / 2, kHeight - 12, "middle", x_label);
  svg += Label(16, (kTop + bottom) / 2, "middle", y_label,
               "transform='rotate(-90 16 " + Number((kTop + bottom) / 2) + ")'");
  for (int i = y.first_mark(); i <= y.last_mark(); ++i) {
    const double mark = i * y.spacing;
    svg += Line(kLeft, at_y(mark), right, at_y(mark), i == y.first_mark() ? "#222" : "#ddd");
    svg += Label(kLeft - 6, at_y(mark) + 4, "end", Number(mark));
  }
  for (int i = x.first_mark(); i <= x.last_mark(); ++i) {
    const double mark = i * x.spacing;
    svg += Line(at_x(mark), bottom, at_x(mark), bottom + 5, "#222");
    svg += Label(at_x(mark), bottom + 18, "middle", Number(mark));
  }
  std::size_t coloured = 0;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const bool reference = curves[i].reference;
    const std::string colour =
        reference ? kReferenceColour : kColours[coloured++ % kColours.size()];
    std::string points;
    for (const auto& point : curves[i].points) {
      if (IsShown(point))
        points += Number(at_x(point.first)) + "," + Number(at_y(point.second)) + " ";
    }
    svg += "<polyline fill='none' stroke='" + colour + "' stroke-width='" +
           (reference ? "3.5' stroke-opacity='0.45"
            : beside  ? "1.6"
                      : "2") +
           "' points='" + points + "'/>\n";
    const double row = kTop + 16 * static_cast<double>(i + 1);
    svg += beside ? Label(right + 12, row, "start", curves[i].name, "style='fill:" + colour + "'")
                  : Label(right - 4, row, "end", curves[i].name, "style='fill:" + colour + "'");
  }
  return svg + "</svg>\n";
}

}  // namespace footing::plot
