#include "daemon/offline/analysis/line_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "daemon/offline/analysis/svg.h"

namespace footing::plot {
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
