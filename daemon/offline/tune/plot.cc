#include "daemon/offline/tune/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace footing::tune {
namespace {

constexpr double kWidth = 640, kHeight = 360, kLeft = 60, kRight = 20, kTop = 40, kBottom = 50;
constexpr std::array kColours{"#1f5fa8", "#c2571a", "#3d8b37", "#8a4fa0", "#7a7a7a", "#b8860b"};

std::string Number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

std::string Escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    escaped += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  }
  return escaped;
}

/// 1, 2 or 5 times a power of ten: about five marks up to `largest`.
double MarkSpacing(double largest) {
  const double rough = largest / 5;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) return factor * power;
  }
  return 10 * power;
}

struct Scale {
  double largest = 0, spacing = 1;

  void Close() {
    if (!(largest > 0)) largest = 1;
    spacing = MarkSpacing(largest);
    largest = spacing * std::ceil(largest / spacing - 1e-9);
  }
};

std::string Label(double x, double y, const std::string& anchor, const std::string& text,
                  const std::string& more = "") {
  return "<text x='" + Number(x) + "' y='" + Number(y) + "' text-anchor='" + anchor + "' " + more +
         ">" + Escaped(text) + "</text>\n";
}

std::string Line(double x1, double y1, double x2, double y2, const char* colour) {
  return "<line x1='" + Number(x1) + "' y1='" + Number(y1) + "' x2='" + Number(x2) + "' y2='" +
         Number(y2) + "' stroke='" + colour + "'/>\n";
}

}  // namespace

std::string LinePlot(const std::string& title, const std::string& x_label,
                     const std::string& y_label, const std::vector<Curve>& curves) {
  Scale x, y;
  const auto shown = [](const std::pair<double, double>& point) {
    return std::isfinite(point.first) && std::isfinite(point.second);
  };
  for (const Curve& curve : curves) {
    for (const auto& point : curve.points) {
      if (!shown(point)) continue;
      x.largest = std::max(x.largest, point.first);
      y.largest = std::max(y.largest, point.second);
    }
  }
  x.Close();
  y.Close();
  const double bottom = kHeight - kBottom, right = kWidth - kRight;
  const auto at_x = [&](double value) { return kLeft + value / x.largest * (right - kLeft); };
  const auto at_y = [&](double value) { return bottom - value / y.largest * (bottom - kTop); };

  std::string svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 " + Number(kWidth) + " " +
                    Number(kHeight) + "' font-family='sans-serif' font-size='12' fill='#222'>\n" +
                    "<rect width='100%' height='100%' fill='white'/>\n";
  svg += Label(kWidth / 2, 22, "middle", title, "font-size='14'");
  svg += Label((kLeft + right) / 2, kHeight - 12, "middle", x_label);
  svg += Label(16, (kTop + bottom) / 2, "middle", y_label,
               "transform='rotate(-90 16 " + Number((kTop + bottom) / 2) + ")'");
  for (double mark = 0; mark <= y.largest * 1.0001; mark += y.spacing) {
    svg += Line(kLeft, at_y(mark), right, at_y(mark), mark == 0 ? "#222" : "#ddd");
    svg += Label(kLeft - 6, at_y(mark) + 4, "end", Number(mark));
  }
  for (double mark = 0; mark <= x.largest * 1.0001; mark += x.spacing) {
    svg += Line(at_x(mark), bottom, at_x(mark), bottom + 5, "#222");
    svg += Label(at_x(mark), bottom + 18, "middle", Number(mark));
  }
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const std::string colour = kColours[i % kColours.size()];
    std::string points;
    for (const auto& point : curves[i].points) {
      if (shown(point))
        points += Number(at_x(point.first)) + "," + Number(at_y(point.second)) + " ";
    }
    svg += "<polyline fill='none' stroke='" + colour + "' stroke-width='2' points='" + points +
           "'/>\n";
    svg += Label(right - 4, kTop + 16 * static_cast<double>(i + 1), "end", curves[i].name,
                 "style='fill:" + colour + "'");
  }
  return svg + "</svg>\n";
}

}  // namespace footing::tune
