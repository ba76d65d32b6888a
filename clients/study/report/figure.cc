#include "clients/study/report/figure.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "common/text/number.h"

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

std::string Label(double x, double y, const std::string& anchor, const std::string& text) {
  return "<text x=\"" + N(x) + "\" y=\"" + N(y) + "\" text-anchor=\"" + anchor + "\">" +
         Escaped(text) + "</text>";
}

/// Linear between the two nearest values; `sorted` has one at least.
double Quartile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

struct Axis {
  double least = 0, greatest = 1;
  double Y(double value) const {
    return kTop + (kHeight - kTop - kBottom) * (greatest - value) / (greatest - least);
  }
};

std::string Box(double x, const Axis& axis, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double low = axis.Y(Quartile(values, 0.25)), high = axis.Y(Quartile(values, 0.75));
  const double median = axis.Y(Quartile(values, 0.5));
  return "<rect x=\"" + N(x - kBoxWidth / 2) + "\" y=\"" + N(high) + "\" width=\"" + N(kBoxWidth) +
         "\" height=\"" + N(low - high) + "\"/>" +
         Line(x - kBoxWidth / 2, median, x + kBoxWidth / 2, median, "median");
}

}  // namespace

std::vector<double> Ticks(double least, double greatest) {
  const double span = std::max(greatest - least, 1e-9);
  double step = std::pow(10, std::floor(std::log10(span / kMostTicks)));
  for (const double factor : {2.0, 2.5, 2.0}) {  // 1, 2, 5, 10 times the power of ten.
    if (span / step > kMostTicks) step *= factor;
  }
  std::vector<double> ticks;
  const double first = std::floor(least / step), last = std::ceil(greatest / step);
  for (double i = first; i <= std::max(last, first + 1); ++i) ticks.push_back(i * step);
  return ticks;
}

std::string Figure(const Measure& measure, const plan::Protocol& protocol) {
  std::vector<std::string> names = {protocol.control};
  for (const std::string& one : protocol.interfaces) {
    if (one != protocol.control) names.push_back(one);
  }
  double least = 0, greatest = 0;  // Zero belongs to all of the scales.
  for (const Value& one : measure.values) {
    least = std::min(least, one.value);
    greatest = std::max(greatest, one.value);
  }
  const std::vector<double> ticks = Ticks(least, greatest);
  const Axis axis{ticks.front(), ticks.back()};
  const double width = kLeft + kColumn * static_cast<double>(names.size());
  std::string svg = "<svg viewBox=\"0 0 " + N(width) + " " + N(kHeight) + "\" width=\"" + N(width) +
                    "\" role=\"img\" aria-label=\"" + Escaped(measure.title) + "\">";
  for (const double tick : ticks) {
    svg += Line(kLeft, axis.Y(tick), width, axis.Y(tick), "grid") +
           Label(kLeft - 6, axis.Y(tick) + 4, "end", text::Shortest(std::round(tick * 1e9) / 1e9));
  }
  std::map<std::string, double> x_of;
  for (std::size_t i = 0; i < names.size(); ++i) {
    x_of[names[i]] = kLeft + kColumn * (static_cast<double>(i) + 0.5);
    svg += Label(x_of[names[i]], kHeight - 8, "middle", names[i]);
    const std::vector<double> values = measure.Of(names[i]);
    if (!values.empty()) svg += Box(x_of[names[i]], axis, values);
  }
  std::map<std::string, std::map<double, double>> people;  // Participant to y over x.
  for (const Value& one : measure.values) {
    people[one.participant][x_of[one.interface]] = axis.Y(one.value);
  }
  for (const auto& [participant, points] : people) {
    std::string path;
    for (const auto& [x, y] : points) path += (path.empty() ? "M" : "L") + N(x) + " " + N(y);
    svg += "<path class=\"pair\" d=\"" + path + "\"/>";
    for (const auto& [x, y] : points) {
      svg += "<circle cx=\"" + N(x) + "\" cy=\"" + N(y) + "\" r=\"" + N(kPointRadius) +
             "\"><title>" + Escaped(participant) + "</title></circle>";
    }
  }
  return svg + "</svg>";
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
