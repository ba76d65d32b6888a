#pragma once

#include <string>
#include <utility>
#include <vector>

namespace footing::plot {

struct Curve {
  std::string name;
  std::vector<std::pair<double, double>> points;  ///< x, y; x rising.
  bool reference = false;                         ///< The truth: dark and broad, under the others.
};

enum class Axes {
  kFromZero,  ///< Both begin at zero; the legend is in the corner.
  kFitted,    ///< x is as long as the curves, y from mark to mark; the legend is beside them.
};

/// A line plot as SVG text: axes with round marks, a legend. Numbers that are not finite are left
/// out.
std::string LinePlot(const std::string& title, const std::string& x_label,
                     const std::string& y_label, const std::vector<Curve>& curves,
                     Axes axes = Axes::kFromZero);

}  // namespace footing::plot
