#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "clients/view/render/hud_layout.h"
#include "clients/view/render/paint.h"
#include "clients/view/scene/model.h"

namespace footing::render {

/// Heights that the panel asks for.
PanelHeight StripPanelHeight(const scene::StripSet& strips);

/// The sensor features of the last 10 s, or of paint.window, one controller under the other, at
/// most four and as many as the box has space for. The curves stand still while nothing comes.
/// Where the mouse is over them, a line through all of them and the values there.
void DrawStripPanel(const Paint& paint, const Box& box, const scene::StripSet& strips,
                    std::int64_t now_ns);

/// One curve of a plot.
struct Curve {
  const scene::Strip* strip = nullptr;
  ImU32 ink = 0;
  const char* name = "";  ///< For the legend, where a plot has more than one.
  float width = 1.4f;
  std::string value =
      {};  ///< Value under the mouse, for the legend; empty: the mouse is elsewhere.
};

/// Curves over one axis.
struct Plot {
  const char* title = "";
  std::string value;        ///< The newest value with its unit, or that under the mouse.
  float low = 0, high = 1;  ///< Ends of the axis, in the strips' own unit.
  double label_factor = 1;  ///< From the strips' own unit to that of the labels.
  std::vector<Curve> curves;
  float share = 1;  ///< Share of the column's height.
};

/// Width of the labels to the left of the curves, in units.
inline constexpr float kAxisWidth = 30;
/// Height of the labels under a column of plots, in units.
inline constexpr float kTimeAxisHeight = 14;

/// Plots one under the other over paint.window before `now_ns`.
void DrawPlots(const Paint& paint, const Box& box, const std::vector<Plot>& plots,
               std::int64_t now_ns);
/// Seconds before the newest instant, from the top of `box`, under a column of plots.
void DrawTimeAxis(const Paint& paint, const Box& box);
/// Column of an instant, pixels, between the left and the right edge of the curves of a column.
float PlotX(const Paint& paint, const Box& box, std::int64_t time_ns, std::int64_t now_ns);

/// Place of a column of the picture within the curves of the strips' panel, 0 left to 1 right.
double ShareOfStrips(const Box& panel, float scale, float column);

}  // namespace footing::render
