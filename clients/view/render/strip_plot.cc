#include "clients/view/render/strip_plot.h"

#include <algorithm>
#include <cmath>

#include "clients/view/scene/words.h"

namespace footing::render {
namespace {

constexpr float kSpaceForZero = 34;  // Height at which zero has a label of its own.
constexpr float kLegendHeight = 15;
constexpr float kLegendAboveFrom = 36;  // Height at which the words have a row of their own.
constexpr double kGridS = 2;
constexpr double kStripS = static_cast<double>(scene::kStripNs) * 1e-9;

/// The part of a column's plot that holds the curves.
Box CurvesOf(const Paint& p, const Box& box) {
  return {{box.low.x + kAxisWidth * p.scale, box.low.y}, box.high};
}

float YAt(const Box& curves, const Plot& plot, float value) {
  const float share = std::clamp((value - plot.low) / (plot.high - plot.low), 0.0f, 1.0f);
  return curves.high.y - share * curves.height();
}

void DrawCurve(const Paint& p, const Box& box, const Box& curves, const Plot& plot,
               const Curve& curve, std::int64_t now_ns) {
  const auto flush = [&] { p.list->PathStroke(curve.ink, 0, curve.width * p.scale); };
  const auto& points = curve.strip->points();
  float last_x = -1e9f, last_value = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const scene::Strip::Point& point = points[i];
    if (point.time_ns > now_ns) break;
    // What has left the strip draws no line at its edge.
    if (points[std::min(i + 1, points.size() - 1)].time_ns <= now_ns - scene::kStripNs) continue;
    const float x = PlotX(p, box, point.time_ns, now_ns);
    // A phase that wraps from pi to -pi draws no line across the strip.
    const bool wraps = std::abs(point.value - last_value) > 0.9f * (plot.high - plot.low);
    if (!point.joined || wraps) flush();
    last_value = point.value;
    // More than one point a pixel shows nothing more.
    if (point.joined && !wraps && x - last_x < 0.8f && i + 1 < points.size()) continue;
    p.list->PathLineTo({x, YAt(curves, plot, point.value)});
    last_x = x;
  }
  flush();
}

void DrawAxes(const Paint& p, const Box& curves, const Plot& plot) {
  const float s = p.scale;
  p.list->AddRectFilled(curves.low, curves.high, IM_COL32(255, 255, 255, 10), 3 * s);
  for (double age_s = kGridS; age_s < kStripS; age_s += kGridS) {
    const float x = curves.high.x - static_cast<float>(age_s / kStripS) * curves.width();
    p.list->AddLine({x, curves.low.y}, {x, curves.high.y}, IM_COL32(255, 255, 255, 16));
  }
  const auto label = [&](float value, float y) {
    const double shown = static_cast<double>(value) * plot.label_factor;
    p.WriteRight(p.fonts.tiny, {curves.low.x - 4 * s, y}, colour::kFaint, scene::Fixed(shown, 0));
  };
  const float letters = p.fonts.tiny->FontSize;
  label(plot.high, curves.low.y - 1 * s);
  label(plot.low, curves.high.y - letters);
  if (plot.low < 0 && plot.high > 0) {
    const float zero = YAt(curves, plot, 0);
    p.list->AddLine({curves.low.x, zero}, {curves.high.x, zero}, colour::kGroove);
    if (curves.height() > kSpaceForZero * s) label(0, zero - letters / 2);
  }
}

/// The title, in the curve's colour or followed by every curve's name in its own, and the value.
void DrawLegend(const Paint& p, const Box& curves, const Plot& plot) {
  const float s = p.scale, line = curves.low.y + kLegendHeight * s;
  const bool one = plot.curves.size() == 1, titled = *plot.title != '\0';
  float names = titled ? 0 : -6 * s;
  if (!one) {
    for (const Curve& curve : plot.curves) names += p.WidthOf(p.fonts.small, curve.name) + 6 * s;
  }
  const float width = p.WidthOf(p.fonts.small, plot.title) + names + 10 * s;
  // In a low plot the words are over the curve: they stay readable, and it is seen behind them.
  const float value_start = curves.high.x - 10 * s - p.WidthOf(p.fonts.small, plot.value);
  p.list->AddRectFilled(curves.low, {curves.low.x + width, line}, colour::kBehindText, 3 * s);
  p.list->AddRectFilled({value_start, curves.low.y}, {curves.high.x, line}, colour::kBehindText,
                        3 * s);
  float x = curves.low.x + (titled ? 5 : -1) * s;
  x += p.Write(p.fonts.small, {x, curves.low.y}, one ? plot.curves[0].ink : colour::kFaint,
               plot.title);
  for (const Curve& curve : plot.curves) {
    if (one) break;
    x += 6 * s;
    x += p.Write(p.fonts.small, {x, curves.low.y}, curve.ink, curve.name);
  }
  p.WriteRight(p.fonts.small, {curves.high.x - 5 * s, curves.low.y}, colour::kText, plot.value);
}

void DrawPlot(const Paint& p, const Box& box, const Plot& plot, std::int64_t now_ns) {
  const Box whole = CurvesOf(p, box);
  Box curves = whole;
  if (whole.height() >= kLegendAboveFrom * p.scale) curves.low.y += kLegendHeight * p.scale;
  DrawAxes(p, curves, plot);
  p.list->PushClipRect(curves.low, curves.high, true);
  for (const Curve& curve : plot.curves) DrawCurve(p, box, curves, plot, curve, now_ns);
  p.list->PopClipRect();
  DrawLegend(p, whole, plot);
}

}  // namespace

float PlotX(const Paint& p, const Box& box, std::int64_t time_ns, std::int64_t now_ns) {
  const Box curves = CurvesOf(p, box);
  const double age = static_cast<double>(now_ns - time_ns) / static_cast<double>(scene::kStripNs);
  return curves.high.x - static_cast<float>(std::clamp(age, 0.0, 1.0)) * curves.width();
}

void DrawPlots(const Paint& p, const Box& box, const std::vector<Plot>& plots,
               std::int64_t now_ns) {
  const float gap = 4 * p.scale;
  float shares = 0;
  for (const Plot& plot : plots) shares += plot.share;
  const float unit = (box.height() - gap * static_cast<float>(plots.size() - 1)) / shares;
  float y = box.low.y;
  for (const Plot& plot : plots) {
    const float next = y + unit * plot.share;
    DrawPlot(p, {{box.low.x, y}, {box.high.x, next}}, plot, now_ns);
    y = next + gap;
  }
}

void DrawTimeAxis(const Paint& p, const Box& box) {
  const Box curves = CurvesOf(p, box);
  const auto text = [](double age_s) { return scene::Fixed(-age_s, 0) + " s"; };
  p.Write(p.fonts.tiny, curves.low, colour::kFaint, text(kStripS));
  p.WriteCentred(p.fonts.tiny, {(curves.low.x + curves.high.x) / 2, curves.low.y}, colour::kFaint,
                 text(kStripS / 2));
  p.WriteRight(p.fonts.tiny, {curves.high.x, curves.low.y}, colour::kFaint, text(0));
}

}  // namespace footing::render
