#include "clients/view/scene/camera_preview.h"

#include <algorithm>

#include "clients/view/scene/interface_text.h"
#include "common/base/number.h"
#include "common/base/units.h"

namespace footing::scene {
namespace {

using preview::Sight;

PreviewLine LineOf(const preview::Sphere& sphere) {
  const std::string role = RoleText(sphere.role);
  switch (sphere.sight) {
    case Sight::kNothing:
      return {role + ": not seen; nothing of its colour is in the picture"};
    case Sight::kOther:
      return {role + ": not seen; the light of its colour is hidden, too small or not round"};
    case Sight::kChecking:
      return {role + ": being checked; its light is switched off and on"};
    case Sight::kSeen:
      break;
  }
  const std::string seen = role + ": " + text::Fixed(sphere.range_m, 2) + " m, confidence " +
                           text::Fixed(sphere.confidence, 2);
  if (sphere.is_saturated) return {seen + "; too bright: lower the exposure"};
  if (sphere.is_occluded) return {seen + "; partly hidden"};
  return {seen, true};
}

}  // namespace

double PreviewAgeS(const CameraPreview& preview, std::int64_t now_ns) {
  if (!preview.picture) return 0;
  return std::max(0.0, NanosecondsToSeconds(now_ns - preview.picture->exposed_ns));
}

std::string PreviewTrouble(const CameraPreview& preview, std::int64_t now_ns) {
  const std::string since =
      preview.picture
          ? " The last picture is " + text::Fixed(PreviewAgeS(preview, now_ns), 1) + " s old."
          : "";
  switch (preview.state) {
    case CameraPreview::State::kNone:
      return "";
    case CameraPreview::State::kAbsent:
      return "footing-camera is not running (" + preview.why +
             "); start it, or name its socket with --camera-address." + since;
    case CameraPreview::State::kWaiting:
      return "footing-camera is running, but has no frame yet." + since;
    case CameraPreview::State::kRefused:
      return "No preview: " + preview.why + "." + since;
    case CameraPreview::State::kShown:
      break;
  }
  if (PreviewAgeS(preview, now_ns) < kPreviewStaleS) return "";
  return "The stream stopped." + since;
}

std::vector<PreviewLine> PreviewLines(const preview::Picture& picture) {
  std::vector<PreviewLine> lines;
  for (const preview::Sphere& sphere : picture.spheres) lines.push_back(LineOf(sphere));
  if (!picture.has_pose)
    lines.push_back({"where the camera stands is not calibrated: hands are not in the world"});
  return lines;
}

namespace {

/// All of it for a terminal.
std::vector<std::string> PreviewScreen(const CameraPreview& preview, std::int64_t now_ns) {
  const std::string trouble = PreviewTrouble(preview, now_ns);
  if (!trouble.empty()) return {trouble};
  std::vector<std::string> lines;
  if (!preview.picture) return lines;
  lines.push_back("frame " + std::to_string(preview.picture->number) + ", " +
                  text::Fixed(1e3 * PreviewAgeS(preview, now_ns), 0) + " ms old" +
                  (preview.picture->simulated ? "   [SIMULATED]" : ""));
  for (const PreviewLine& line : PreviewLines(*preview.picture)) lines.push_back(line.text);
  for (const preview::RefusedLight& light : preview.picture->refused)
    lines.push_back("a light that stays lit was refused for the " + RoleText(light.role) + " at " +
                    text::Fixed(light.circle.u_px, 0) + ", " + text::Fixed(light.circle.v_px, 0) +
                    " px");
  return lines;
}

}  // namespace

void AddPreviewLines(const CameraPreview& preview, std::int64_t now_ns,
                     std::vector<std::string>& lines) {
  if (preview.state == CameraPreview::State::kNone) return;
  lines.push_back("Camera");
  for (const std::string& line : PreviewScreen(preview, now_ns)) lines.push_back("  " + line);
}

std::string PreviewStatus(const CameraPreview& preview, std::int64_t now_ns) {
  std::string status;
  for (const std::string& line : PreviewScreen(preview, now_ns))
    status += (status.empty() ? "" : "   ") + line;
  return status;
}

}  // namespace footing::scene
