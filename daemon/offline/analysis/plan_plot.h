#pragma once

#include <array>
#include <string>
#include <vector>

namespace footing::plot {

/// A filled area, or with two corners a line. Metres, x to the right, y up.
struct PlanShape {
  std::vector<std::array<double, 2>> corners;
  std::string colour;
};

struct PlanPanel {
  std::string name;
  std::vector<PlanShape> shapes;  ///< Later ones are drawn over earlier ones.
};

/// What a colour means.
struct PlanKey {
  std::string colour;
  std::string meaning;
};

/// Plan views at one scale, in rows, with a scale of 10 m and the colours' meanings under them.
/// Shapes that are not finite are left out.
std::string PlanPlot(const std::string& title, const std::vector<PlanPanel>& panels,
                     const std::vector<PlanKey>& keys);

}  // namespace footing::plot
