#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "clients/camera/preview_picture.h"
#include "common/runtime/flag.h"
#include "common/runtime/latest.h"
#include "common/net/listener.h"

namespace footing::camera {

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
  boost::asio::steady_timer look_;
  std::unique_ptr<transport::Listener> listener_;
  std::vector<std::shared_ptr<Viewer>> viewers_;
  std::thread thread_;
};

}  // namespace footing::camera
