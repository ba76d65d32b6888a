#include "clients/view/render/hud/strip_panel.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "clients/view/scene/words.h"
#include "common/units/units.h"

namespace footing::render {
namespace {

constexpr std::size_t kMaxStripDevices = 4;
constexpr float kDeviceHeight = 180;
constexpr float kStripPhaseHeight = 30;
constexpr float kLeastRowHeight = 24;

/// A row of curves over the same range.
struct Curve {
  const scene::Strip* strip = nullptr;
  ImU32 ink = 0;
  float width = 1.4f;
};
struct Row {
  const char* name = "";
  std::string value;  ///< The newest value with its unit.
  float low = 0, high = 1;
  std::vector<Curve> curves;
  float share = 1;  ///< Of the column's height.
};

float XAt(const Box& box, std::int64_t time_ns, std::int64_t now_ns) {
  const double age = static_cast<double>(now_ns - time_ns) / static_cast<double>(scene::kStripNs);
  return box.high.x - static_cast<float>(std::clamp(age, 0.0, 1.0)) * box.width();
}

void DrawCurve(const Paint& p, const Box& box, const Row& row, const Curve& curve,
               std::int64_t now_ns) {
  const auto y_at = [&](float value) {
    const float share = std::clamp((value - row.low) / (row.high - row.low), 0.0f, 1.0f);
    return box.high.y - share * box.height();
  };
  const auto& points = curve.strip->points();
  const auto flush = [&] { p.list->PathStroke(curve.ink, 0, curve.width * p.scale); };
  float last_x = -1e9f, last_value = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const scene::Strip::Point& point = points[i];
    const float x = XAt(box, point.time_ns, now_ns);
    // A phase that wraps from pi to -pi is no line across the strip.
    const bool wraps = std::abs(point.value - last_value) > 0.9f * (row.high - row.low);
    if (!point.joined || wraps) flush();
    last_value = point.value;
    // More than one point a pixel shows nothing more.
    if (point.joined && !wraps && x - last_x < 0.8f && i + 1 < points.size()) continue;
    p.list->PathLineTo({x, y_at(point.value)});
    last_x = x;
  }
  flush();
}

/// Shades the time in which the controller moves.
void ShadeMoving(const Paint& p, const Box& box, const scene::Strip& moving, std::int64_t now_ns) {
  const auto& points = moving.points();
  for (std::size_t i = 0; i < points.size();) {
    std::size_t end = i;
    while (end + 1 < points.size() && points[end + 1].value == points[i].value) ++end;
    const std::size_t until = std::min(end + 1, points.size() - 1);
    if (points[i].value > 0.5f) {
      p.list->AddRectFilled({XAt(box, points[i].time_ns, now_ns), box.low.y},
                            {XAt(box, points[until].time_ns, now_ns), box.high.y},
                            Faded(colour::kGood, 0.10f));
    }
    i = end + 1;
  }
}

std::string NewestOf(const scene::Strip& strip, std::int64_t now_ns, int decimals, double factor,
                     const char* unit) {
  if (strip.points().empty()) return "-";
  const scene::Strip::Point& newest = strip.points().back();
  if (now_ns - newest.time_ns > kNanosecondsPerSecond / 2) return "-";
  return scene::Fixed(factor * static_cast<double>(newest.value), decimals) + unit;
}

/// The least of a few ranges that shows the strip whole; the last is the Wiimote's 3.6 g on all
/// three axes at once, 9.81 * 3.6 * sqrt(3) m/s2.
float ReachOf(const scene::Strip& magnitude) {
  float largest = 0;
  for (const scene::Strip::Point& point : magnitude.points()) {
    largest = std::max(largest, point.value);
  }
  for (const float reach : {22.0f, 40.0f}) {
    if (largest <= reach) return reach;
  }
  return 62;
}

std::vector<Row> RowsOf(const scene::DeviceStrips& d, std::int64_t now_ns) {
  const double degrees = RadiansToDegrees(1);
  const float reach_mps2 = ReachOf(d.magnitude_mps2);
  return {
      {"acceleration",
       NewestOf(d.magnitude_mps2, now_ns, 1, 1, " m/s\xc2\xb2"),
       -reach_mps2,
       reach_mps2,
       {{&d.filtered_x_mps2, Faded(colour::kAccent, 0.85f)},
        {&d.filtered_y_mps2, Faded(colour::kGood, 0.85f)},
        {&d.filtered_z_mps2, Faded(colour::kThird, 0.85f)},
        {&d.magnitude_mps2, colour::kText, 1.0f}},
       2.1f},
      {"frequency",
       NewestOf(d.frequency_hz, now_ns, 2, 1, " Hz"),
       0,
       5,
       {{&d.frequency_hz, colour::kSecond, 2.0f}}},
      {"amplitude",
       NewestOf(d.amplitude_mps2, now_ns, 1, 1, " m/s\xc2\xb2"),
       0,
       30,
       {{&d.amplitude_mps2, colour::kGood, 2.0f}}},
      {"roll, pitch",
       NewestOf(d.roll_rad, now_ns, 0, degrees, "\xc2\xb0, ") +
           NewestOf(d.pitch_rad, now_ns, 0, degrees, "\xc2\xb0"),
       static_cast<float>(-kPi / 2),
       static_cast<float>(kPi / 2),
       {{&d.roll_rad, colour::kAccent, 2.0f}, {&d.pitch_rad, colour::kThird, 2.0f}}},
  };
}

void DrawRow(const Paint& p, const Box& box, const Row& row, std::int64_t now_ns) {
  const float s = p.scale;
  p.list->AddRectFilled(box.low, box.high, IM_COL32(255, 255, 255, 10), 3 * s);
  if (row.low < 0 && row.high > 0) {
    const float zero = box.high.y + row.low / (row.high - row.low) * box.height();
    p.list->AddLine({box.low.x, zero}, {box.high.x, zero}, colour::kGroove);
  }
  p.list->PushClipRect(box.low, box.high, true);
  for (const Curve& curve : row.curves) DrawCurve(p, box, row, curve, now_ns);
  p.list->PopClipRect();
  // Words stay readable over a curve.
  const float line = box.low.y + 15 * s;
  const float name_end = box.low.x + 10 * s + p.WidthOf(p.fonts.small, row.name);
  const float value_start = box.high.x - 10 * s - p.WidthOf(p.fonts.small, row.value);
  p.list->AddRectFilled(box.low, {name_end, line}, colour::kBehindText, 3 * s);
  p.list->AddRectFilled({value_start, box.low.y}, {box.high.x, line}, colour::kBehindText, 3 * s);
  p.Write(p.fonts.small, {box.low.x + 5 * s, box.low.y}, colour::kFaint, row.name);
  p.WriteRight(p.fonts.small, {box.high.x - 5 * s, box.low.y}, colour::kText, row.value);
}

void DrawRows(const Paint& p, const Box& box, const std::vector<Row>& rows, std::int64_t now_ns) {
  const float gap = 4 * p.scale;
  float shares = 0;
  for (const Row& row : rows) shares += row.share;
  const float unit = (box.height() - gap * static_cast<float>(rows.size() - 1)) / shares;
  float y = box.low.y;
  for (const Row& row : rows) {
    const float next = y + unit * row.share;
    DrawRow(p, {{box.low.x, y}, {box.high.x, next}}, row, now_ns);
    y = next + gap;
  }
}

void DrawDevice(const Paint& p, const Box& box, const scene::DeviceStrips& device,
                std::int64_t now_ns) {
  const float s = p.scale;
  std::string role = stream::Name(device.role);
  std::replace(role.begin(), role.end(), '_', ' ');
  const float width = p.Write(p.fonts.strong, box.low, colour::kText, role);
  const bool moving = !device.moving.points().empty() && device.moving.points().back().value > 0;
  p.Label({box.low.x + width + 8 * s, box.low.y}, moving ? colour::kGood : colour::kGroove,
          moving ? IM_COL32(10, 30, 16, 255) : colour::kFaint, moving ? "moving" : "still");
  if (device.simulated) {
    p.WriteRight(p.fonts.small, {box.high.x, box.low.y + 2 * s}, colour::kSecond, "SIMULATED");
  }
  const Box rows_box{{box.low.x, box.low.y + 23 * s}, box.high};
  ShadeMoving(p, rows_box, device.moving, now_ns);
  std::vector<Row> rows = RowsOf(device, now_ns);
  // Where there is little room, the first rows say most.
  while (rows.size() > 1 &&
         rows_box.height() < kLeastRowHeight * s * (1 + static_cast<float>(rows.size()))) {
    rows.pop_back();
  }
  DrawRows(p, rows_box, rows, now_ns);
}

void DrawPhase(const Paint& p, const Box& box, const scene::Strip& phase, std::int64_t now_ns) {
  const Row row{"phase, right minus left",
                NewestOf(phase, now_ns, 0, RadiansToDegrees(1), "\xc2\xb0"),
                static_cast<float>(-kPi),
                static_cast<float>(kPi),
                {{&phase, colour::kSecond, 2.0f}}};
  DrawRow(p, box, row, now_ns);
}

}  // namespace

void DrawStripPanel(const Paint& p, const Box& box, const scene::StripSet& strips,
                    std::int64_t now_ns) {
  const std::size_t devices = std::min(strips.devices.size(), kMaxStripDevices);
  if (devices == 0) return;
  const auto count = static_cast<float>(devices);
  const float s = p.scale, gap = 10 * s;
  const float phase_height = strips.phases_rad.empty() ? 0 : kStripPhaseHeight * s + gap;
  const float room = box.height() - 28 * s - phase_height;
  const float height = std::min(kDeviceHeight * s, (room - gap * (count - 1)) / count);
  const float used = count * (height + gap) - gap + phase_height + 28 * s;
  const Box in = p.Panel({box.low, {box.high.x, box.low.y + used}});
  float y = in.low.y;
  std::size_t drawn = 0;
  for (const auto& [key, device] : strips.devices) {
    if (drawn++ == devices) break;
    DrawDevice(p, {{in.low.x, y}, {in.high.x, y + height}}, device, now_ns);
    y += height + gap;
  }
  if (strips.phases_rad.empty()) return;
  DrawPhase(p, {{in.low.x, y}, in.high}, strips.phases_rad.begin()->second, now_ns);
}

}  // namespace footing::render
