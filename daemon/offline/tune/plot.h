#pragma once

#include <string>
#include <utility>
#include <vector>

namespace footing::tune {

struct Curve {
  std::string name;
  std::vector<std::pair<double, double>> points;  ///< x, y; x rising.
};

/// A line plot as SVG text: axes from zero with round marks, a legend. Numbers that are not finite
/// are left out.
std::string LinePlot(const std::string& title, const std::string& x_label,
                     const std::string& y_label, const std::vector<Curve>& curves);

}  // namespace footing::tune
