#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "clients/view/app/feed.h"
#include "clients/view/app/pose_calibration.h"
#include "clients/view/app/preview_link.h"
#include "clients/view/scene/show.h"
#include "common/runtime/bounded_queue.h"
#include "common/runtime/flag.h"
#include "common/runtime/latest.h"

namespace footing::view {

/// The io thread: receives ticks there and hands them to the render thread through a bounded
/// queue. Ctrl-C and SIGTERM raise a flag.
class Background {
 public:
  explicit Background(const Options& options);
  ~Background();
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  /// Render thread: takes in all that has come; a calibration goes on with it.
  void Drain(scene::Show& show, PoseCalibration* calibration);
  /// Sends a command to the servers of that name, from the io thread.
  void SendTo(const std::string& server_id, v1::Command command);
  /// Receives the preview of footing-camera from now on, or no longer.
  void WantPreview(bool wanted);
  bool stop_asked() const { return stop_.raised(); }

 private:
  void RunOnIoThread();

  boost::asio::io_context io_;
  boost::asio::signal_set signals_;
  exchange::BoundedQueue<scene::Update> updates_;
  std::vector<std::unique_ptr<exchange::Latest<scene::LinkReport>>> links_;
  exchange::Flag stop_;
  exchange::Latest<scene::CameraPreview> preview_;
  Feed feed_;
  PreviewLink preview_link_;
  bool preview_wanted_ = false;
  std::thread thread_;
};

}  // namespace footing::view
