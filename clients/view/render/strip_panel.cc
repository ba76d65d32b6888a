#include "clients/view/render/strip_panel.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "clients/view/scene/text.h"
#include "common/base/units.h"

namespace footing::render {
namespace {

constexpr std::size_t kMaxStripDevices = 4;
constexpr float kStripMargins = 28;
constexpr float kStripDeviceHeight = 190, kLeastStripDeviceHeight = 66;
constexpr float kStripHeadingHeight = 23;
constexpr float kStripPhaseHeight = 34;
constexpr float kStripGap = 10;
constexpr float kLeastRowHeight = 26;

/// Shades the time in which the controller moves.
void ShadeMoving(const Paint& p, const Box& box, const scene::Strip& moving, std::int64_t now_ns) {
  const auto& points = moving.points();
  for (std::size_t i = 0; i < points.size();) {
    std::size_t end = i;
    while (end + 1 < points.size() && points[end + 1].value == points[i].value) ++end;
    const std::size_t until = std::min(end + 1, points.size() - 1);
    if (points[i].value > 0.5f) {
      p.list->AddRectFilled({PlotX(p, box, points[i].time_ns, now_ns), box.low.y},
                            {PlotX(p, box, points[until].time_ns, now_ns), box.high.y},
                            Faded(colour::kGood, 0.10f));
    }
    i = end + 1;
  }
}

/// Instants of a column of plots.
struct Instants {
  std::int64_t now_ns = 0;                ///< End of the curves.
  std::optional<std::int64_t> cursor_ns;  ///< Instant under the mouse.
};

/// The value at the mouse, else the newest one.
std::string ValueOf(const scene::Strip& strip, const Instants& at, int decimals, double factor,
                    const char* unit) {
  const std::int64_t time_ns = at.cursor_ns.value_or(at.now_ns);
  const auto& points = strip.points();
  const auto after = std::upper_bound(
      points.begin(), points.end(), time_ns,
      [](std::int64_t ns, const scene::Strip::Point& point) { return ns < point.time_ns; });
  // In the past a value holds up to the next point; the newest one is the present one for a while.
  if (after == points.begin()) return "-";
  if (after != points.end() && !after->joined) return "-";
  const scene::Strip::Point& point = *std::prev(after);
  if (time_ns - point.time_ns > scene::kCurrentNs) return "-";
  return scene::Fixed(factor * static_cast<double>(point.value), decimals) + unit;
}

/// Roll and pitch, or one dash where either is unknown.
std::string InclinationOf(const scene::DeviceStrips& d, const Instants& at) {
  const double degrees = RadiansToDegrees(1);
  const std::string roll = ValueOf(d.roll_rad, at, 0, degrees, "\xc2\xb0");
  const std::string pitch = ValueOf(d.pitch_rad, at, 0, degrees, "\xc2\xb0");
  return roll == "-" || pitch == "-" ? "-" : roll + ", " + pitch;
}

/// The least of a few ranges that shows the strip whole; the last is the Wiimote's 3.6 g on all
/// three axes at once, 9.81 * 3.6 * sqrt(3) m/s2.
float RangeOf(const scene::Strip& magnitude) {
  float largest = 0;
  for (const scene::Strip::Point& point : magnitude.points()) {
    largest = std::max(largest, point.value);
  }
  for (const float range : {22.0f, 40.0f}) {
    if (largest <= range) return range;
  }
  return 62;
}

std::vector<Plot> PlotsOf(const scene::DeviceStrips& d, const Instants& at) {
  const float range_mps2 = RangeOf(d.magnitude_mps2);
  const auto axis = [&](const scene::Strip& strip) {
    return at.cursor_ns ? ValueOf(strip, at, 1, 1, "") : "";
  };
  return {
      {at.cursor_ns ? "" : "acceleration",
       ValueOf(d.magnitude_mps2, at, 1, 1, " m/s\xc2\xb2"),
       -range_mps2,
       range_mps2,
       1,
       {{&d.filtered_x_mps2, Faded(colour::kAccent, 0.85f), "x", 1.4f, axis(d.filtered_x_mps2)},
        {&d.filtered_y_mps2, Faded(colour::kGood, 0.85f), "y", 1.4f, axis(d.filtered_y_mps2)},
        {&d.filtered_z_mps2, Faded(colour::kThird, 0.85f), "z", 1.4f, axis(d.filtered_z_mps2)},
        {&d.magnitude_mps2, colour::kText, "norm", 1.0f}},
       2.1f},
      {"frequency",
       ValueOf(d.frequency_hz, at, 2, 1, " Hz"),
       0,
       5,
       1,
       {{&d.frequency_hz, colour::kSecond, "", 2.0f}}},
      {"amplitude",
       ValueOf(d.amplitude_mps2, at, 1, 1, " m/s\xc2\xb2"),
       0,
       30,
       1,
       {{&d.amplitude_mps2, colour::kGood, "", 2.0f}}},
      {"",
       InclinationOf(d, at),
       static_cast<float>(-kPi / 2),
       static_cast<float>(kPi / 2),
       RadiansToDegrees(1),
       {{&d.roll_rad, colour::kAccent, "roll", 2.0f},
        {&d.pitch_rad, colour::kThird, "pitch", 2.0f}}},
  };
}

void DrawDeviceStrips(const Paint& p, const Box& box, const scene::DeviceStrips& device,
                      const Instants& at) {
  const float s = p.scale;
  const std::string role = scene::RoleText(device.role);
  const float width = p.Write(p.fonts.strong, box.low, colour::kText, role);
  const bool moving = !device.moving.points().empty() && device.moving.points().back().value > 0;
  p.Label({box.low.x + width + 8 * s, box.low.y}, moving ? colour::kGood : colour::kGroove,
          moving ? IM_COL32(10, 30, 16, 255) : colour::kFaint, moving ? "moving" : "still");
  if (device.simulated) {
    p.WriteRight(p.fonts.small, {box.high.x, box.low.y + 2 * s}, colour::kSecond, "SIMULATED");
  }
  const Box plots_box{{box.low.x, box.low.y + kStripHeadingHeight * s}, box.high};
  ShadeMoving(p, plots_box, device.moving, at.now_ns);
  std::vector<Plot> plots = PlotsOf(device, at);
  // Where there is little space, the first plots say most.
  while (plots.size() > 1 &&
         plots_box.height() < kLeastRowHeight * s * (1 + static_cast<float>(plots.size()))) {
    plots.pop_back();
  }
  DrawPlots(p, plots_box, plots, at.now_ns);
}

void DrawPhase(const Paint& p, const Box& box, const scene::Strip& phase, const Instants& at) {
  const double degrees = RadiansToDegrees(1);
  DrawPlots(p, box,
            {{"phase, right minus left",
              ValueOf(phase, at, 0, degrees, "\xc2\xb0"),
              static_cast<float>(-kPi),
              static_cast<float>(kPi),
              degrees,
              {{&phase, colour::kSecond, "", 2.0f}}}},
            at.now_ns);
}

bool Holds(const Box& box, ImVec2 at) {
  return at.x >= box.low.x && at.x < box.high.x && at.y >= box.low.y && at.y < box.high.y;
}

/// A line through the whole column under the mouse, with its age; nothing beside the curves.
std::optional<std::int64_t> DrawCursor(const Paint& p, const Box& in, std::int64_t now_ns) {
  const float s = p.scale, x = p.pointer->x, left = in.low.x + kAxisWidth * s;
  if (x < left || x > in.high.x) return std::nullopt;
  const double share = static_cast<double>((in.high.x - x) / (in.high.x - left));
  const double age_s = p.window.age_s + share * p.window.span_s;
  p.list->AddLine({x, in.low.y + kStripHeadingHeight * s}, {x, in.high.y}, colour::kText, s);
  const std::string text = scene::Fixed(-age_s, 2) + " s";
  const float half = p.WidthOf(p.fonts.tiny, text) / 2 + 4 * s;
  const float middle = std::clamp(x, left + half, in.high.x - half);
  const float top = in.high.y - (kTimeAxisHeight - 3) * s;
  p.list->AddRectFilled({middle - half, top}, {middle + half, in.high.y}, colour::kText, 3 * s);
  p.WriteCentred(p.fonts.tiny, {middle, top}, IM_COL32(20, 20, 20, 255), text);
  return now_ns - SecondsToNanoseconds(age_s);
}

float PhaseSpace(const scene::StripSet& strips) {
  return strips.phases_rad.empty() ? 0 : kStripPhaseHeight + kStripGap;
}

/// Height of so many controllers with all that is around them.
float StripsHeight(const scene::StripSet& strips, std::size_t devices, float device_height) {
  const auto count = static_cast<float>(devices);
  return kStripMargins + kTimeAxisHeight + PhaseSpace(strips) +
         count * (device_height + kStripGap) - kStripGap;
}

}  // namespace

PanelHeight StripPanelHeight(const scene::StripSet& strips) {
  const std::size_t devices = std::min(strips.devices.size(), kMaxStripDevices);
  if (devices == 0) return {};
  return {StripsHeight(strips, 1, kLeastStripDeviceHeight),
          StripsHeight(strips, devices, kStripDeviceHeight)};
}

void DrawStripPanel(const Paint& p, const Box& box, const scene::StripSet& strips,
                    std::int64_t now_ns) {
  const float s = p.scale;
  std::size_t devices = std::min(strips.devices.size(), kMaxStripDevices);
  while (devices > 1 && StripsHeight(strips, devices, kLeastStripDeviceHeight) * s > box.height()) {
    --devices;
  }
  const Box in = p.Panel(box);
  const float axis = in.high.y - (kTimeAxisHeight - 3) * s;
  DrawTimeAxis(p, {{in.low.x, axis}, in.high});
  Instants at{scene::ShownTime(strips.newest_ns, now_ns), {}};
  if (p.pointer && Holds(box, *p.pointer)) at.cursor_ns = DrawCursor(p, in, at.now_ns);
  const float bottom = in.high.y - kTimeAxisHeight * s;
  const float space = bottom - in.low.y - PhaseSpace(strips) * s;
  const float height = (space + kStripGap * s) / static_cast<float>(devices) - kStripGap * s;
  float y = in.low.y;
  std::size_t drawn = 0;
  for (const auto& [key, device] : strips.devices) {
    if (drawn++ == devices) break;
    DrawDeviceStrips(p, {{in.low.x, y}, {in.high.x, y + height}}, device, at);
    y += height + kStripGap * s;
  }
  if (strips.phases_rad.empty()) return;
  DrawPhase(p, {{in.low.x, y}, {in.high.x, bottom}}, strips.phases_rad.begin()->second, at);
}

namespace {

constexpr float kSpaceForZero = 34;  // Height at which zero has a label of its own.
constexpr float kLegendHeight = 15;
constexpr float kLegendAboveFrom = 36;  // Height at which the words have a row of their own.
constexpr float kMostGridLines = 6;

/// The part of a column's plot that holds the curves.
Box CurvesOf(const Paint& p, const Box& box) {
  return {{box.low.x + kAxisWidth * p.scale, box.low.y}, box.high};
}

/// Column of an instant, also beside the curves.
float ColumnOf(const Paint& p, const Box& curves, std::int64_t time_ns, std::int64_t now_ns) {
  const double age_s = NanosecondsToSeconds(now_ns - time_ns) - p.window.age_s;
  return curves.high.x - static_cast<float>(age_s / p.window.span_s) * curves.width();
}

/// Step of the grid, s: 1, 2 or 5 of a power of ten.
double GridStepS(double span_s) {
  double step_s = 0.01;
  for (int i = 0; span_s / step_s > static_cast<double>(kMostGridLines); ++i) {
    step_s *= i % 3 == 1 ? 2.5 : 2;
  }
  return step_s;
}

float YAt(const Box& curves, const Plot& plot, float value) {
  const float share = std::clamp((value - plot.low) / (plot.high - plot.low), 0.0f, 1.0f);
  return curves.high.y - share * curves.height();
}

void DrawCurve(const Paint& p, const Box& box, const Box& curves, const Plot& plot,
               const Curve& curve, std::int64_t now_ns) {
  const auto flush = [&] { p.list->PathStroke(curve.ink, 0, curve.width * p.scale); };
  const auto& points = curve.strip->points();
  const Box whole = CurvesOf(p, box);
  const std::int64_t left_ns = now_ns - SecondsToNanoseconds(p.window.age_s + p.window.span_s);
  float last_x = -1e9f, last_value = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const scene::Strip::Point& point = points[i];
    if (point.time_ns > now_ns || last_x > curves.high.x) break;
    // Points that have left the strip draw no line at its edge.
    if (points[std::min(i + 1, points.size() - 1)].time_ns <= left_ns) continue;
    const float x = ColumnOf(p, whole, point.time_ns, now_ns);
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
  const double step_s = GridStepS(p.window.span_s), end_s = p.window.age_s + p.window.span_s;
  for (double age_s = step_s * std::ceil(p.window.age_s / step_s); age_s < end_s; age_s += step_s) {
    const auto away = static_cast<float>((age_s - p.window.age_s) / p.window.span_s);
    const float x = curves.high.x - away * curves.width();
    if (x <= curves.low.x + 1 || x >= curves.high.x - 1) continue;
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

/// The curve's name, with its value where the mouse is over it.
std::string TextOf(const Curve& curve) {
  return curve.value.empty() ? curve.name : curve.name + (" " + curve.value);
}

/// The title, in the curve's colour or followed by every curve's name in its own, and the value.
void DrawLegend(const Paint& p, const Box& curves, const Plot& plot) {
  const float s = p.scale, line = curves.low.y + kLegendHeight * s;
  const bool one = plot.curves.size() == 1, titled = *plot.title != '\0';
  float names = titled ? 0 : -6 * s;
  if (!one) {
    for (const Curve& curve : plot.curves) names += p.WidthOf(p.fonts.small, TextOf(curve)) + 6 * s;
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
    x += p.Write(p.fonts.small, {x, curves.low.y}, curve.ink, TextOf(curve));
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
  return std::clamp(ColumnOf(p, curves, time_ns, now_ns), curves.low.x, curves.high.x);
}

double ShareOfStrips(const Box& panel, float scale, float column) {
  const float margin = kStripMargins / 2 * scale;
  const float left = panel.low.x + margin + kAxisWidth * scale;
  return static_cast<double>((column - left) / (panel.high.x - margin - left));
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
  const double first_s = p.window.age_s, span_s = p.window.span_s;
  const int decimals = first_s == 0 && span_s == scene::TimeWindow::kLongestS ? 0 : 2;
  const auto text = [decimals](double age_s) {
    return age_s == 0 ? "0 s" : scene::Fixed(-age_s, decimals) + " s";
  };
  p.Write(p.fonts.tiny, curves.low, colour::kFaint, text(first_s + span_s));
  p.WriteCentred(p.fonts.tiny, {(curves.low.x + curves.high.x) / 2, curves.low.y}, colour::kFaint,
                 text(first_s + span_s / 2));
  p.WriteRight(p.fonts.tiny, {curves.high.x, curves.low.y}, colour::kFaint, text(first_s));
}

}  // namespace footing::render
