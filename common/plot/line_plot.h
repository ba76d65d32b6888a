#pragma once

#include <array>
#include <string>
#include <utility>
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

/// Plots as SVG text.
inline constexpr std::array kColours{"#1f5fa8", "#c2571a", "#3d8b37",
                                     "#8a4fa0", "#7a7a7a", "#b8860b"};
inline constexpr const char* kReferenceColour = "#222";

/// A number as text, with six significant digits.
std::string Number(double value);

/// With the characters that SVG and HTML give a meaning escaped.
std::string Escaped(const std::string& text);

/// The opening of an SVG of this size, white.
std::string Open(double width, double height);

/// Text with its special characters escaped; `more` are further attributes.
std::string Label(double x, double y, const std::string& anchor, const std::string& text,
                  const std::string& more = "");

/// A line as an SVG element; `more` has further attributes.
std::string Line(double x1, double y1, double x2, double y2, const std::string& colour,
                 const std::string& more = "");

/// A filled area, or with two corners a line. Metres, x to the right, y up.
struct PlanShape {
  std::vector<std::array<double, 2>> corners;
  std::string colour;
};

/// One of the plans side by side in a PlanPlot.
struct PlanPanel {
  std::string name;
  std::vector<PlanShape> shapes;  ///< Later ones are drawn over earlier ones.
};

/// Legend entry: the meaning of a colour.
struct PlanKey {
  std::string colour;
  std::string meaning;
};

/// Plan views at one scale, in rows, with a scale of 10 m and the colours' meanings under them.
/// Shapes that are not finite are left out.
std::string PlanPlot(const std::string& title, const std::vector<PlanPanel>& panels,
                     const std::vector<PlanKey>& keys);

/// A curve of a line plot.
struct Curve {
  std::string name;
  std::vector<std::pair<double, double>> points;  ///< x, y; x rising.
  bool reference = false;                         ///< The truth: dark and broad, under the others.
};

/// Ranges of a line plot's axes.
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
