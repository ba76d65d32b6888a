#include <algorithm>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cmath>

#include "clients/camera/source.h"
#include "common/runtime/clock.h"
#include "common/frames/frame_folder.h"

namespace footing::camera {
namespace {

class FolderSource : public Source {
 public:
  FolderSource(boost::asio::io_context& io, std::vector<std::string> files,
               const frames::CameraFile& camera, bool repeats)
      : timer_(io), files_(std::move(files)), camera_(camera), repeats_(repeats) {}

  void Start(OnFrame on_frame, OnEnd on_end) override {
    on_frame_ = std::move(on_frame);
    on_end_ = std::move(on_end);
    due_ = std::chrono::steady_clock::now();
    Wait();
  }

  void Stop() override {
    is_stopped_ = true;
    timer_.cancel();
  }

 private:
  void Wait() {
    timer_.expires_at(due_);
    timer_.async_wait([this](boost::system::error_code error) {
      // It may have expired before Stop() cancelled it.
      if (!error && !is_stopped_) Deliver();
    });
  }

  void Deliver() {
    if (next_ == files_.size()) {
      if (!repeats_) return on_end_({});
      next_ = 0;
    }
    const auto frame = frames::ReadFrame(files_[next_++], camera_.lens.width, camera_.lens.height);
    if (!frame) return on_end_(frame.error());
    const std::int64_t exposed_ns = clock::MonotonicNs();
    // At the camera's rate; what could not be had in time is not made up for. Before the frame is
    // handed on, which may end in Stop().
    due_ = std::max(due_ + std::chrono::nanoseconds(std::llround(1e9 / camera_.rate_hz)),
                    std::chrono::steady_clock::now());
    Wait();
    on_frame_(*frame, exposed_ns);
  }

  boost::asio::steady_timer timer_;
  const std::vector<std::string> files_;
  const frames::CameraFile camera_;
  const bool repeats_;
  OnFrame on_frame_;
  OnEnd on_end_;
  std::size_t next_ = 0;
  bool is_stopped_ = false;
  std::chrono::steady_clock::time_point due_;
};

}  // namespace

Result<std::unique_ptr<Source>> OpenFolder(boost::asio::io_context& io, const std::string& folder,
                                           const frames::CameraFile& camera, bool repeats) {
  auto files = frames::FramesOf(folder);
  if (!files) return files.error();
  return std::unique_ptr<Source>(
      std::make_unique<FolderSource>(io, *std::move(files), camera, repeats));
}

}  // namespace footing::camera
