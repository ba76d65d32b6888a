#include "clients/view/render/device_panels.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "clients/view/scene/stage.h"
#include "clients/view/scene/text.h"
#include "common/base/text.h"
#include "common/base/units.h"

namespace footing::render {
namespace {

/// One plate seen from above, front up, with the trace of the last 10 s fading away.
void DrawPlate(const Paint& p, const Box& space, const stream::BoardGeometry& geometry,
               const scene::BoardTrace& board, std::int64_t now_ns) {
  const float s = p.scale;
  const auto wide_m = static_cast<float>(geometry.plate_x_m),
             deep_m = static_cast<float>(geometry.plate_y_m);
  const float pixels_per_m = std::min(space.width() / wide_m, space.height() / deep_m);
  const ImVec2 centre((space.low.x + space.high.x) / 2, (space.low.y + space.high.y) / 2);
  const ImVec2 half(wide_m / 2 * pixels_per_m, deep_m / 2 * pixels_per_m);
  const auto at = [&](float x_m, float y_m) {
    return ImVec2(centre.x + x_m * pixels_per_m, centre.y - y_m * pixels_per_m);
  };
  p.list->AddRectFilled({centre.x - half.x, centre.y - half.y},
                        {centre.x + half.x, centre.y + half.y}, IM_COL32(255, 255, 255, 22), 9 * s);
  p.list->AddRect({centre.x - half.x, centre.y - half.y}, {centre.x + half.x, centre.y + half.y},
                  colour::kGroove, 9 * s, 0, 1.5f * s);
  p.list->AddLine({centre.x, centre.y - half.y}, {centre.x, centre.y + half.y}, colour::kGroove);
  p.list->AddLine({centre.x - half.x, centre.y}, {centre.x + half.x, centre.y}, colour::kGroove);
  for (std::size_t i = 1; i < board.points.size(); ++i) {
    const auto& a = board.points[i - 1];
    const auto& b = board.points[i];
    if (!b.joined) continue;
    const double age =
        static_cast<double>(now_ns - b.time_ns) / static_cast<double>(scene::kStripNs);
    const auto opacity = static_cast<float>(std::clamp(1 - age, 0.05, 1.0));
    p.list->AddLine(at(a.x_m, a.y_m), at(b.x_m, b.y_m), Faded(colour::kAccent, opacity), 1.6f * s);
  }
  if (board.newest.cop_valid) {
    p.Dot(at(static_cast<float>(board.newest.cop_x_m), static_cast<float>(board.newest.cop_y_m)), 5,
          colour::kText);
  }
}

void DrawSplit(const Paint& p, const Box& box, const scene::Stance& stance) {
  const float s = p.scale;
  const auto share = static_cast<float>(stance.left_share);
  const float middle = box.low.x + share * box.width();
  const Box bar{{box.low.x, box.low.y + 18 * s}, {box.high.x, box.low.y + 26 * s}};
  p.list->AddRectFilled(bar.low, {middle - s, bar.high.y}, colour::kAccent, 4 * s,
                        ImDrawFlags_RoundCornersLeft);
  p.list->AddRectFilled({middle + s, bar.low.y}, bar.high, colour::kSecond, 4 * s,
                        ImDrawFlags_RoundCornersRight);
  p.list->AddLine({(box.low.x + box.high.x) / 2, bar.low.y - 3 * s},
                  {(box.low.x + box.high.x) / 2, bar.high.y + 3 * s}, colour::kText);
  p.Write(p.fonts.small, box.low, colour::kAccent,
          "left " + scene::Fixed(100 * stance.left_share, 0) + " %");
  p.WriteRight(p.fonts.small, {box.high.x, box.low.y}, colour::kSecond,
               "right " + scene::Fixed(100 - 100 * stance.left_share, 0) + " %");
}

}  // namespace

void DrawBoardPanel(const Paint& p, const Box& box, const scene::Model& model,
                    std::int64_t now_ns) {
  if (model.boards.empty()) return;
  const float s = p.scale;
  const Box in = p.Panel(box);
  const scene::Stance stance = scene::StanceOf(model);
  p.Write(p.fonts.strong, in.low, colour::kText, "balance");
  p.WriteRight(
      p.fonts.strong, {in.high.x, in.low.y}, stance.valid ? colour::kText : colour::kFaint,
      stance.valid ? scene::Fixed(NewtonsToKilograms(stance.total_n), 1) + " kg" : "nobody on it");
  const float top = in.low.y + 24 * s, bottom = in.high.y - 32 * s;
  const auto count = static_cast<float>(model.boards.size());
  const float width = in.width() / count;
  float x = in.low.x;
  for (const auto& [key, board] : model.boards) {
    DrawPlate(p, {{x + 2 * s, top}, {x + width - 2 * s, bottom}}, scene::GeometryOf(model, key),
              board, now_ns);
    x += width;
  }
  if (stance.valid) DrawSplit(p, {{in.low.x, bottom + 6 * s}, in.high}, stance);
}

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

/// Part of the panel that is shown.
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

namespace {

using preview::Sight;

constexpr PanelHeight kCameraHeight{250, 350};
constexpr float kTitleHeight = 22, kLineHeight = 17, kGapBelowPicture = 7;
constexpr float kLeastRadius = 5;
constexpr ImU32 kNoPicture = IM_COL32(8, 11, 15, 255), kVeil = IM_COL32(8, 11, 15, 190);

ImU32 InkOf(const preview::Sphere& sphere) {
  switch (sphere.sight) {
    case Sight::kSeen:
      return sphere.is_saturated || sphere.is_occluded ? colour::kWarning : colour::kGood;
    case Sight::kChecking:
      return colour::kWarning;
    case Sight::kNothing:
    case Sight::kOther:
      break;
  }
  return colour::kBad;
}

/// Where a picture of those sides fits into the space, in its middle.
Box FittedInto(const Box& space, int width, int height) {
  const auto across = static_cast<float>(width), down = static_cast<float>(height);
  const float share = std::min(space.width() / across, space.height() / down);
  const ImVec2 half(across * share / 2, down * share / 2);
  const ImVec2 middle((space.low.x + space.high.x) / 2, (space.low.y + space.high.y) / 2);
  return {{middle.x - half.x, middle.y - half.y}, {middle.x + half.x, middle.y + half.y}};
}

/// From the camera's pixels, whose first one has its middle at 0, to the screen.
struct Projection {
  Box box;
  float scale = 1;

  ImVec2 At(const preview::Circle& circle) const {
    return {box.low.x + (circle.u_px + 0.5f) * scale, box.low.y + (circle.v_px + 0.5f) * scale};
  }
};

void DrawSphere(const Paint& p, const Projection& to, const preview::Sphere& sphere) {
  if (!(sphere.circle.radius_px > 0)) return;
  const float s = p.scale;
  const ImVec2 at = to.At(sphere.circle);
  const float radius = std::max(kLeastRadius * s, sphere.circle.radius_px * to.scale + 2 * s);
  const ImU32 ink = InkOf(sphere);
  p.list->AddCircle(at, radius, ink, 32, 1.6f * s);
  const std::string name = scene::RoleText(sphere.role);
  const float width = p.WidthOf(p.fonts.tiny, name);
  const float left =
      std::clamp(at.x - width / 2, to.box.low.x, std::max(to.box.low.x, to.box.high.x - width));
  const bool above = at.y + radius + 14 * s > to.box.high.y;
  p.Write(p.fonts.tiny, {left, above ? at.y - radius - 13 * s : at.y + radius + s}, ink, name);
}

void DrawRefused(const Paint& p, const Projection& to, const preview::RefusedLight& light) {
  const float s = p.scale, half = 5 * s;
  const ImVec2 at = to.At(light.circle);
  p.list->AddLine({at.x - half, at.y - half}, {at.x + half, at.y + half}, colour::kBad, 1.6f * s);
  p.list->AddLine({at.x - half, at.y + half}, {at.x + half, at.y - half}, colour::kBad, 1.6f * s);
  const char* const why = "refused: stays lit";
  const float right = at.x + half + 3 * s, width = p.WidthOf(p.fonts.tiny, why);
  const float left = right + width > to.box.high.x ? at.x - half - 3 * s - width : right;
  p.Write(p.fonts.tiny, {left, at.y - 6 * s}, colour::kBad, why);
}

void DrawPicture(const Paint& p, const Box& space, const preview::Picture& picture) {
  const Box box = FittedInto(space, picture.width, picture.height);
  p.list->AddImage(p.camera_picture, box.low, box.high);
  p.list->PushClipRect(box.low, box.high, true);
  // A row or column of quads may be cut off at the far side: the scale is that of whole pixels.
  const int step = std::max(1, picture.camera_width / picture.width);
  const Projection to{box, box.width() / static_cast<float>(picture.width * step)};
  for (const preview::RefusedLight& light : picture.refused) DrawRefused(p, to, light);
  for (const preview::Sphere& sphere : picture.spheres) DrawSphere(p, to, sphere);
  p.list->PopClipRect();
}

void DrawTrouble(const Paint& p, const Box& space, const std::string& trouble) {
  p.list->AddRectFilled(space.low, space.high, kVeil);
  const float step = p.fonts.small->FontSize + 3 * p.scale;
  const auto lines = p.Wrapped(p.fonts.small, trouble, space.width() - 16 * p.scale);
  float y = (space.low.y + space.high.y - step * static_cast<float>(lines.size())) / 2;
  for (const std::string& line : lines) {
    p.WriteCentred(p.fonts.small, {(space.low.x + space.high.x) / 2, y}, colour::kWarning, line);
    y += step;
  }
}

struct ShownLine {
  std::string text;
  bool is_good = false;
};

std::vector<ShownLine> LinesOf(const Paint& p, const preview::Picture& picture, float width) {
  std::vector<ShownLine> lines;
  for (const scene::PreviewLine& line : scene::PreviewLines(picture))
    for (std::string& part : p.Wrapped(p.fonts.small, line.text, width))
      lines.push_back({std::move(part), line.is_good});
  return lines;
}

}  // namespace

PanelHeight CameraPanelHeight(const scene::CameraPreview& preview) {
  return preview.state == scene::CameraPreview::State::kNone ? PanelHeight() : kCameraHeight;
}

void DrawCameraPanel(const Paint& p, const Box& box, const scene::CameraPreview& preview,
                     std::int64_t now_ns) {
  const float s = p.scale;
  const Box in = p.Panel(box);
  const std::string trouble = scene::PreviewTrouble(preview, now_ns);
  p.Write(p.fonts.strong, in.low, colour::kText, "Camera");
  std::vector<ShownLine> lines;
  if (preview.picture) {
    const double age_s = scene::PreviewAgeS(preview, now_ns);
    const bool simulated = preview.picture->simulated;
    p.WriteRight(
        p.fonts.small, {in.high.x, in.low.y + 2 * s},
        ColourOfAge(100 * age_s / scene::kPreviewStaleS),
        (simulated ? "simulated, " : "") + text::Fixed(age_s, age_s < 10 ? 2 : 0) + " s old");
    if (trouble.empty()) lines = LinesOf(p, *preview.picture, in.width());
  }
  // However many lines there are, half of the panel is the picture's.
  const auto most = static_cast<std::size_t>(std::max(0.0f, in.height() / 2 / (kLineHeight * s)));
  if (lines.size() > most) lines.resize(most);
  const float text_height =
      lines.empty() ? 0 : (kGapBelowPicture + kLineHeight * static_cast<float>(lines.size())) * s;
  const Box space{{in.low.x, in.low.y + kTitleHeight * s}, {in.high.x, in.high.y - text_height}};
  p.list->AddRectFilled(space.low, space.high, kNoPicture, 4 * s);
  if (preview.picture && p.camera_picture != nullptr) DrawPicture(p, space, *preview.picture);
  if (!trouble.empty()) DrawTrouble(p, space, trouble);
  float y = space.high.y + kGapBelowPicture * s;
  for (const ShownLine& line : lines) {
    p.Write(p.fonts.small, {in.low.x, y}, line.is_good ? colour::kText : colour::kWarning,
            line.text);
    y += kLineHeight * s;
  }
}

namespace {

constexpr float kWidestBanner = 900;
constexpr float kSide = 22, kTop = 14, kLineGap = 5;
constexpr ImU32 kFill = IM_COL32(150, 24, 24, 236);
constexpr std::size_t kTitleLines = 3;

struct LostLines {
  ImFont* font = nullptr;
  std::vector<std::string> lines;
};
using LostText = std::array<LostLines, 3>;

LostText TextIn(const Paint& p, const scene::LostSignal& lost, const std::array<ImFont*, 3>& fonts,
                float width) {
  return {{{fonts[0], p.Wrapped(fonts[0], lost.what, width)},
           {fonts[1], p.Wrapped(fonts[1], lost.effect, width)},
           {fonts[2], p.Wrapped(fonts[2], lost.advice, width)}}};
}

float HeightOf(const LostText& text, float scale) {
  float height = 2 * kTop * scale;
  for (const LostLines& part : text) {
    height += static_cast<float>(part.lines.size()) * (part.font->FontSize + kLineGap * scale);
  }
  return height;
}

/// In letters as large as fit into the space.
LostText FittingText(const Paint& p, const scene::LostSignal& lost, float width, float height) {
  const Fonts& f = p.fonts;
  const std::array<std::array<ImFont*, 3>, 3> sets{{{f.title, f.heading, f.strong},
                                                    {f.heading, f.strong, f.text},
                                                    {f.strong, f.small, f.small}}};
  for (const auto& fonts : sets) {
    const LostText text = TextIn(p, lost, fonts, width);
    const bool few = text[0].lines.size() <= kTitleLines;
    if (few && HeightOf(text, p.scale) <= height) return text;
  }
  return TextIn(p, lost, sets.back(), width);
}

}  // namespace

void DrawLostPanel(const Paint& p, const scene::CharacterPose& pose, Box& space) {
  const auto lost = scene::LostSignalOf(pose);
  if (!lost) return;
  const float s = p.scale;
  const float inner = std::min(space.width(), kWidestBanner * s) - 2 * kSide * s;
  const LostText text = FittingText(p, *lost, inner, space.height());
  const float height = HeightOf(text, s);
  float width = 0;
  for (const LostLines& part : text) {
    for (const std::string& line : part.lines) {
      width = std::max(width, p.WidthOf(part.font, line));
    }
  }
  const float middle = (space.low.x + space.high.x) / 2;
  const float half = width / 2 + kSide * s;
  p.list->AddRectFilled({middle - half, space.low.y}, {middle + half, space.low.y + height}, kFill,
                        14 * s);
  float y = space.low.y + kTop * s;
  for (const LostLines& part : text) {
    for (const std::string& line : part.lines) {
      p.WriteCentred(part.font, {middle, y}, colour::kText, line);
      y += part.font->FontSize + kLineGap * s;
    }
  }
  space.low.y += height + 6 * s;
}

}  // namespace footing::render
