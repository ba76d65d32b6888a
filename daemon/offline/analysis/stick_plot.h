#pragma once

#include <array>
#include <string>
#include <vector>

namespace footing::plot {

/// Lines of one figure in the plane: x1, y1, x2, y2; y up, any unit, the same in all panels.
using Sticks = std::vector<std::array<double, 4>>;

/// One picture: the reference under what is compared with it.
struct Panel {
  std::string name;
  Sticks reference;
  Sticks figure;
};

/// Stick figures side by side, at one scale, on one ground line (y = 0). Lines that are not finite
/// are left out.
std::string StickPlot(const std::string& title, const std::vector<Panel>& panels);

}  // namespace footing::plot
