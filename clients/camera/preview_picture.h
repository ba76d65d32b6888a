#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "clients/camera/light_checks.h"
#include "common/frames/camera_file.h"
#include "common/frames/frame.h"
#include "common/camera/preview.h"
#include "common/camera/blobs.h"

namespace footing::camera {

/// One frame and what came of it, as the preview shows it.
struct SeenFrame {
  std::uint64_t number = 0;
  std::int64_t exposed_ns = 0;
  frames::Frame frame;
  std::vector<std::optional<sphere::Estimate>> found;  ///< Before the lights are checked.
  std::vector<LightVerdict> verdicts;
  bool has_pose = false, simulated = false;
};

/// Reduces frames to pictures 320 pixels wide or less, whole quads to a pixel, and says why a
/// sphere is not seen. Slow work, away from the tracking.
class PreviewPainter {
 public:
  explicit PreviewPainter(const frames::CameraFile& camera) : spheres_(camera.spheres) {}
  preview::Picture Paint(const SeenFrame& seen);

 private:
  void PaintPixels(const SeenFrame& seen, preview::Picture& picture) const;
  preview::Sphere SightOf(const SeenFrame& seen, std::size_t sphere) const;

  std::vector<frames::HeldSphere> spheres_;
  sphere::Quads quads_;
};

}  // namespace footing::camera
