#include "clients/view/render/camera_panel.h"

#include <algorithm>
#include <string>

#include "clients/view/scene/interface_text.h"
#include "common/base/number.h"

namespace footing::render {
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

}  // namespace footing::render
