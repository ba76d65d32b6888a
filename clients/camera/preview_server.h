#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "clients/camera/light_checks.h"
#include "common/camera/blobs.h"
#include "common/camera/preview.h"
#include "common/frames/camera_file.h"
#include "common/net/listener.h"
#include "common/runtime/exchange.h"
#include "common/runtime/timer.h"

namespace footing::camera {

/// One frame and what came of it, as the preview shows it.
struct SeenFrame {
  std::uint64_t number = 0;
  std::int64_t exposed_ns = 0;
  frames::Frame frame;
  std::vector<std::optional<sphere::Estimate>> found;  ///< Estimates before the lights are checked.
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

/// Shows frames to viewers of this host, on a thread of its own. The tracking copies a frame while
/// somebody watches and never waits; a viewer that is slow misses pictures, one that takes nothing
/// for 5 s, or sends anything, is cut off.
class PreviewServer {
 public:
  static constexpr std::size_t kMostViewers = 4;
  static constexpr double kRateHz = 12;
  static constexpr std::int64_t kCutOffNs = 5'000'000'000;

  /// Errors say which address, why, and what to do; only Unix sockets are allowed.
  static Result<std::unique_ptr<PreviewServer>> Open(const transport::Address& address,
                                                     const frames::CameraFile& camera,
                                                     std::int64_t cut_off_ns = kCutOffNs);
  ~PreviewServer();
  PreviewServer(const PreviewServer&) = delete;
  PreviewServer& operator=(const PreviewServer&) = delete;

  /// Tracking thread: whether somebody watches and it is time for the next picture.
  bool Wants(std::int64_t now_ns) const;
  /// Tracking thread: what to fill in, whole, with the memory of an earlier frame; then Show.
  SeenFrame& Next() { return seen_.Back(); }
  void Show(std::int64_t now_ns);

 private:
  class Viewer;

  PreviewServer(const frames::CameraFile& camera, std::int64_t cut_off_ns)
      : cut_off_ns_(cut_off_ns), painter_(camera), look_(io_) {}
  void Admit(transport::Socket socket);
  void Look();

  // Between the threads.
  exchange::Latest<SeenFrame> seen_;
  exchange::Flag watched_;
  // The tracking's.
  std::int64_t shown_ns_ = 0;
  // The preview's.
  const std::int64_t cut_off_ns_;
  PreviewPainter painter_;
  boost::asio::io_context io_{1};
  timer::Timer look_;
  std::unique_ptr<transport::Listener> listener_;
  std::vector<std::shared_ptr<Viewer>> viewers_;
  std::thread thread_;
};

}  // namespace footing::camera
