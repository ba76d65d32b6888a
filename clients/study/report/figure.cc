#include "clients/study/report/figure.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "clients/study/report/measure_table.h"
#include "common/statistics/quantile.h"
#include "common/base/number.h"

namespace footing::study::report {
namespace {

// Pixels.
constexpr double kHeight = 220, kTop = 10, kBottom = 30, kLeft = 50, kColumn = 110;
constexpr double kBoxWidth = 44, kPointRadius = 3;
constexpr double kMostTicks = 6;

std::string N(double value) { return text::Fixed(value, 1); }

std::string Line(double x1, double y1, double x2, double y2, const std::string& kind) {
  return "<line class=\"" + kind + "\" x1=\"" + N(x1) + "\" y1=\"" + N(y1) + "\" x2=\"" + N(x2) +
         "\" y2=\"" + N(y2) + "\"/>";
}

/// The middle of a column.
double ColumnX(std::size_t i) { return kLeft + kColumn * (static_cast<double>(i) + 0.5); }

struct Axis {
  double least = 0, greatest = 1;
  double Y(double value) const {
    return kTop + (kHeight - kTop - kBottom) * (greatest - value) / (greatest - least);
  }
};

std::string Box(double x, const Axis& axis, const std::vector<double>& values) {
  const Quartiles box = QuartilesOf(values);
  const double low = axis.Y(box.low), high = axis.Y(box.high), median = axis.Y(box.median);
  return "<rect x=\"" + N(x - kBoxWidth / 2) + "\" y=\"" + N(high) + "\" width=\"" + N(kBoxWidth) +
         "\" height=\"" + N(low - high) + "\"/>" +
         Line(x - kBoxWidth / 2, median, x + kBoxWidth / 2, median, "median");
}

struct Point {
  double x = 0, y = 0;
  std::string title;
  bool censored = false;
};

/// By participant, then from left to right. Points that would cover each other stand side by side.
std::map<std::string, std::vector<Point>> PointsOf(const Measure& measure, const Axis& axis,
                                                   const std::vector<std::string>& names) {
  std::map<std::string, std::vector<Point>> people;
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::map<long, std::vector<const Value*>> at_height;
    for (const Value& one : measure.values) {
      if (one.interface == names[i]) at_height[std::lround(axis.Y(one.value))].push_back(&one);
    }
    for (const auto& [height, together] : at_height) {
      const auto count = static_cast<double>(together.size());
      const double apart = std::min(2 * kPointRadius, kBoxWidth / count);
      for (std::size_t k = 0; k < together.size(); ++k) {
        const Value& one = *together[k];
        people[one.participant].push_back(
            {ColumnX(i) + apart * (static_cast<double>(k) - (count - 1) / 2), axis.Y(one.value),
             one.participant + ": " + text::Shortest(one.value), one.censored});
      }
    }
  }
  return people;
}

}  // namespace

Quartiles QuartilesOf(const std::vector<double>& values) {
  using statistics::QuantileOf;
  return {QuantileOf(values, 0.25), QuantileOf(values, 0.5), QuantileOf(values, 0.75)};
}

std::vector<double> Ticks(double least, double greatest, bool counts) {
  const double span = std::max(greatest - least, 1e-9);
  double step = std::pow(10, std::floor(std::log10(span / kMostTicks)));
  for (const double factor : {2.0, 2.5, 2.0}) {  // 1, 2, 5, 10 times the power of ten.
    if (span / step > kMostTicks) step *= factor;
  }
  if (counts) step = std::max(step, 1.0);
  std::vector<double> ticks;
  const double first = std::floor(least / step), last = std::ceil(greatest / step);
  for (double i = first; i <= std::max(last, first + 1); ++i) ticks.push_back(i * step);
  return ticks;
}

std::string Figure(const Measure& measure, const plan::Protocol& protocol) {
  const std::vector<std::string> names = InOrder(protocol);
  double least = 0, greatest = 0;  // Zero belongs to all of the scales.
  for (const Value& one : measure.values) {
    least = std::min(least, one.value);
    greatest = std::max(greatest, one.value);
  }
  const std::vector<double> ticks = Ticks(least, greatest, measure.counts);
  const Axis axis{ticks.front(), ticks.back()};
  const double width = kLeft + kColumn * static_cast<double>(names.size());
  std::string svg = OpenSvg(width, kHeight, measure.title);
  for (const double tick : ticks) {
    svg += Line(kLeft, axis.Y(tick), width, axis.Y(tick), tick == 0 ? "zero" : "grid") +
           Label(kLeft - 6, axis.Y(tick) + 4, "end", text::Shortest(std::round(tick * 1e9) / 1e9));
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    svg += Label(ColumnX(i), kHeight - 8, "middle", names[i]);
    const std::vector<double> values = measure.Of(names[i]);
    if (!values.empty()) svg += Box(ColumnX(i), axis, values);
  }
  for (const auto& [participant, points] : PointsOf(measure, axis, names)) {
    std::string path, circles;
    for (const Point& one : points) {
      path += (path.empty() ? "M" : "L") + N(one.x) + " " + N(one.y);
      circles += std::string("<circle") + (one.censored ? " class=\"censored\"" : "") + " cx=\"" +
                 N(one.x) + "\" cy=\"" + N(one.y) + "\" r=\"" + N(kPointRadius) + "\"><title>" +
                 Escaped(one.title) + "</title></circle>";
    }
    svg += "<path class=\"pair\" d=\"" + path + "\"/>" + circles;
  }
  return svg + "</svg>";
}

std::string OpenSvg(double width, double height, const std::string& title) {
  return "<svg viewBox=\"0 0 " + N(width) + " " + N(height) + "\" width=\"" + N(width) +
         "\" role=\"img\" aria-label=\"" + Escaped(title) + "\">";
}

std::string Label(double x, double y, const std::string& anchor, const std::string& text) {
  return "<text x=\"" + N(x) + "\" y=\"" + N(y) + "\" text-anchor=\"" + anchor + "\">" +
         Escaped(text) + "</text>";
}

std::string Escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

}  // namespace footing::study::report
