#include "clients/view/render/device_panel.h"

#include <algorithm>
#include <array>

#include "clients/view/scene/interface_text.h"
#include "clients/view/scene/words.h"

namespace footing::render {
namespace {

constexpr float kDevicePanelMargins = 28;
constexpr float kAboveDevices = 8;
constexpr float kLinkRow = 20;
constexpr float kDeviceRow = 40;
constexpr float kShortDeviceRow = 22;
constexpr float kResponseRow = 52;
constexpr std::size_t kMaxListedDevices = 8;

void DrawLink(const Paint& p, const Box& in, float y, const scene::LinkReport& link) {
  const float s = p.scale;
  const std::string name = link.server_id.empty() ? link.address : link.server_id;
  p.Dot({in.low.x + 4 * s, y + 8 * s}, 4, ColourOf(link.state));
  p.Write(p.fonts.small, {in.low.x + 16 * s, y}, colour::kText,
          p.Fitting(p.fonts.small, name, in.width() - 90 * s));
  static constexpr std::array<const char*, 4> kNames{"connecting", "live", "stale", "refused"};
  p.WriteRight(p.fonts.small, {in.high.x, y}, colour::kFaint,
               kNames[static_cast<std::size_t>(link.state)]);
}

void DrawAge(const Paint& p, const Box& in, float y, const scene::Model& model,
             std::int64_t now_ns) {
  const float s = p.scale;
  const double age_ms = scene::AgeMs(model, now_ns);
  p.Write(p.fonts.small, {in.low.x, y}, colour::kFaint, "age of data");
  p.WriteRight(p.fonts.strong, {in.high.x, y - 2 * s}, ColourOfAge(age_ms),
               scene::Fixed(age_ms, 0) + " ms");
}

/// From the user's motion to the first frame that shows it, as a stacked bar.
void DrawResponse(const Paint& p, const Box& in, float y, const scene::Note& note) {
  static constexpr std::array<ImU32, 6> kInks{IM_COL32(140, 160, 180, 255),
                                              colour::kAccent,
                                              IM_COL32(140, 160, 180, 255),
                                              colour::kGood,
                                              colour::kSecond,
                                              colour::kThird};
  const float s = p.scale;
  const auto stages = stream::ResponseTimes(note.response);
  double total_ms = 0;
  for (const stream::ResponseStage& stage : stages) total_ms += stage.ms;
  p.Write(p.fonts.small, {in.low.x, y}, colour::kFaint,
          "response to " + scene::GaitTitle(note.response.to));
  p.WriteRight(p.fonts.small, {in.high.x, y}, colour::kText, scene::Fixed(total_ms, 0) + " ms");
  float x = in.low.x;
  std::size_t longest = 0;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const auto share = static_cast<float>(stages[i].ms / std::max(total_ms, 1e-6));
    const float to = x + share * in.width();
    p.list->AddRectFilled({x, y + 19 * s}, {to, y + 26 * s}, kInks[i]);
    x = to;
    if (stages[i].ms > stages[longest].ms) longest = i;
  }
  if (stages.empty()) return;
  p.Write(p.fonts.small, {in.low.x, y + 30 * s}, kInks[longest],
          std::string(stages[longest].name) + " " + scene::Fixed(stages[longest].ms, 0) +
              " ms, all else " + scene::Fixed(total_ms - stages[longest].ms, 1) + " ms");
}

void DrawBattery(const Paint& p, ImVec2 at, const stream::DeviceStatus& device) {
  const float s = p.scale, w = 22 * s, h = 10 * s;
  p.list->AddRect(at, {at.x + w, at.y + h}, colour::kFaint, 2 * s, 0, s);
  p.list->AddRectFilled({at.x + w, at.y + 3 * s}, {at.x + w + 2 * s, at.y + h - 3 * s},
                        colour::kFaint);
  if (device.battery_fraction < 0) {
    p.WriteCentred(p.fonts.small, {at.x + w / 2, at.y - 2 * s}, colour::kFaint, "?");
    return;
  }
  const auto share = static_cast<float>(std::clamp(device.battery_fraction, 0.0, 1.0));
  const bool low = device.battery_low || share < 0.2f;
  p.list->AddRectFilled({at.x + 2 * s, at.y + 2 * s},
                        {at.x + 2 * s + share * (w - 4 * s), at.y + h - 2 * s},
                        low ? colour::kBad : colour::kGood, s);
}

void DrawDevice(const Paint& p, const Box& in, float y, const stream::DeviceStatus& device,
                bool current, bool second_line) {
  const float s = p.scale;
  p.Dot({in.low.x + 4 * s, y + 9 * s}, 4, current ? ColourOf(device.state) : colour::kFaint);
  const bool has_role = device.role != stream::DeviceRole::kUnspecified;
  const std::string role = has_role ? scene::RoleText(device.role) : stream::Name(device.kind);
  p.Write(p.fonts.strong, {in.low.x + 16 * s, y}, colour::kText, role);
  DrawBattery(p, {in.high.x - 24 * s, y + 4 * s}, device);
  p.WriteRight(p.fonts.small, {in.high.x - 34 * s, y + 1 * s}, colour::kText,
               current ? scene::Fixed(device.report_rate_hz, 0) + " Hz" : "- Hz");
  if (!second_line) return;
  const std::string second =
      device.note.empty()
          ? device.serial + "  " + (current ? stream::Name(device.state) : "unknown")
          : device.note;
  const float stamp = device.simulated ? 92 * s : 0;
  p.Write(p.fonts.small, {in.low.x + 16 * s, y + 18 * s},
          device.note.empty() ? colour::kFaint : colour::kWarning,
          p.Fitting(p.fonts.small, second, in.width() - 16 * s - stamp));
  if (!device.simulated) return;
  p.WriteRight(p.fonts.small, {in.high.x, y + 18 * s}, colour::kSecond, "SIMULATED");
}

/// What of the panel is shown.
struct Extent {
  bool response = false;
  float device_row = kShortDeviceRow;
  std::size_t devices = 0;
};

float DeviceRowsHeight(const scene::Model& model, const Extent& extent) {
  const auto rows = static_cast<float>(model.links.size() + (scene::IsWaiting(model) ? 0 : 1));
  return kDevicePanelMargins + kLinkRow * rows + (extent.response ? kResponseRow : 0) +
         (extent.devices > 0 ? kAboveDevices : 0) +
         extent.device_row * static_cast<float>(extent.devices);
}

Extent FullExtent(const scene::Model& model) {
  return {model.last.response.has_value(), kDeviceRow,
          std::min(model.devices.size(), kMaxListedDevices)};
}

Extent FittingExtent(const scene::Model& model, float height) {
  Extent extent = FullExtent(model);
  if (DeviceRowsHeight(model, extent) > height) extent.response = false;
  if (DeviceRowsHeight(model, extent) > height) extent.device_row = kShortDeviceRow;
  while (extent.devices > 0 && DeviceRowsHeight(model, extent) > height) --extent.devices;
  return extent;
}

}  // namespace

PanelHeight DevicePanelHeight(const scene::Model& model) {
  return {DeviceRowsHeight(model, {}), DeviceRowsHeight(model, FullExtent(model))};
}

void DrawDevicePanel(const Paint& p, const Box& box, const scene::Model& model,
                     std::int64_t now_ns) {
  const float s = p.scale;
  const Extent extent = FittingExtent(model, box.height() / s + 0.5f);
  const Box in = p.Panel({box.low, {box.high.x, box.low.y + DeviceRowsHeight(model, extent) * s}});
  float y = in.low.y;
  for (const scene::LinkReport& link : model.links) {
    DrawLink(p, in, y, link);
    y += kLinkRow * s;
  }
  if (!scene::IsWaiting(model)) {
    DrawAge(p, in, y, model, now_ns);
    y += kLinkRow * s;
  }
  if (extent.response) {
    DrawResponse(p, in, y + 4 * s, *model.last.response);
    y += kResponseRow * s;
  }
  y += kAboveDevices * s;
  for (std::size_t i = 0; i < extent.devices; ++i) {
    const scene::Device& device = model.devices[i];
    DrawDevice(p, in, y, device.status, scene::IsCurrent(model, device),
               extent.device_row == kDeviceRow);
    y += extent.device_row * s;
  }
}

}  // namespace footing::render
