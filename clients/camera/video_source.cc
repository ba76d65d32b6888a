#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <boost/asio/posix/stream_descriptor.hpp>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include "clients/camera/source.h"
#include "clients/camera/video_port.h"
#include "common/runtime/clock.h"

namespace footing::camera {
namespace {

constexpr std::uint32_t kBuffers = 4;
constexpr std::uint64_t kFramesBetweenChecks = 120;  // Of its controls: every few seconds.

class KernelPort : public VideoPort {
 public:
  explicit KernelPort(int descriptor) : descriptor_(descriptor) {}
  int Control(unsigned long request, void* argument) override {
    while (::ioctl(descriptor_, request, argument) != 0) {
      if (errno != EINTR) return errno;
    }
    return 0;
  }

 private:
  int descriptor_;
};

v4l2_buffer BufferOf(std::uint32_t index) {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.index = index;
  return buffer;
}

class VideoSource : public Source {
 public:
  VideoSource(boost::asio::io_context& io, int descriptor, const frames::CameraFile& camera,
              const VideoSettings& settings, std::function<void(const std::string&)> alarm)
      : device_(io, descriptor),
        port_(descriptor),
        camera_(camera),
        settings_(settings),
        alarm_(std::move(alarm)) {}

  ~VideoSource() override {
    for (const Mapped& one : mapped_) ::munmap(one.start, one.size);
  }

  Result<void> Open() {
    if (const auto agreed = Negotiate(port_, camera_); !agreed) return agreed;
    for (const std::string& line : LockControls(port_, settings_)) alarm_(line);
    controls_.emplace(port_, settings_);
    return Map();
  }

  void Start(OnFrame on_frame, OnEnd on_end) override {
    on_frame_ = std::move(on_frame);
    on_end_ = std::move(on_end);
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (const int error = port_.Control(VIDIOC_STREAMON, &type); error != 0)
      return on_end_(Failure("camera: it does not start: " + std::string(std::strerror(error))));
    Wait();
  }

  void Stop() override {
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    port_.Control(VIDIOC_STREAMOFF, &type);
    boost::system::error_code ignored;
    device_.cancel(ignored);
  }

 private:
  struct Mapped {
    void* start;
    std::size_t size;
  };

  Result<void> Map() {
    v4l2_requestbuffers request{};
    request.count = kBuffers;
    request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    request.memory = V4L2_MEMORY_MMAP;
    if (const int error = port_.Control(VIDIOC_REQBUFS, &request); error != 0)
      return Failure("camera: no buffers: " + std::string(std::strerror(error)));
    for (std::uint32_t i = 0; i < request.count; ++i) {
      v4l2_buffer buffer = BufferOf(i);
      if (const int error = port_.Control(VIDIOC_QUERYBUF, &buffer); error != 0)
        return Failure("camera: no buffer: " + std::string(std::strerror(error)));
      void* start = ::mmap(nullptr, buffer.length, PROT_READ | PROT_WRITE, MAP_SHARED,
                           device_.native_handle(), buffer.m.offset);
      if (start == MAP_FAILED)
        return Failure("camera: a buffer cannot be mapped: " + std::string(std::strerror(errno)));
      mapped_.push_back({start, buffer.length});
      port_.Control(VIDIOC_QBUF, &buffer);
    }
    return {};
  }

  void Wait() {
    device_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                       [this](boost::system::error_code error) {
                         if (!error) Take();
                       });
  }

  /// The newest waiting frame; older ones only cost time.
  void Take() {
    v4l2_buffer newest{};
    bool has_one = false;
    while (true) {
      v4l2_buffer buffer = BufferOf(0);
      const int error = port_.Control(VIDIOC_DQBUF, &buffer);
      if (error == EAGAIN) break;
      if (error != 0)
        return on_end_(Failure("camera: it is gone: " + std::string(std::strerror(error))));
      if (has_one) port_.Control(VIDIOC_QBUF, &newest);
      newest = buffer;
      has_one = true;
    }
    if (has_one) Deliver(newest);
    if (++frames_ % kFramesBetweenChecks == 0)
      for (const std::string& line : controls_->Check()) alarm_(line);
    Wait();
  }

  void Deliver(v4l2_buffer& buffer) {
    const int width = camera_.lens.width, height = camera_.lens.height;
    const auto size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                      static_cast<std::size_t>(sphere::BytesPerPixel(camera_.format));
    const Mapped& mapped = mapped_[buffer.index % mapped_.size()];
    const bool is_whole = buffer.bytesused >= size && mapped.size >= size &&
                          (buffer.flags & V4L2_BUF_FLAG_ERROR) == 0;
    if (is_whole) {
      const auto* bytes = static_cast<const std::uint8_t*>(mapped.start);
      const frames::Frame frame{camera_.format, width, height, {bytes, bytes + size}, {}};
      on_frame_(frame, ExposedNs(buffer, camera_, settings_.exposure_s, clock::MonotonicNs()));
    }
    port_.Control(VIDIOC_QBUF, &buffer);
  }

  boost::asio::posix::stream_descriptor device_;
  KernelPort port_;
  const frames::CameraFile camera_;
  const VideoSettings settings_;
  const std::function<void(const std::string&)> alarm_;
  std::optional<LockedControls> controls_;
  std::uint64_t frames_ = 0;
  std::vector<Mapped> mapped_;
  OnFrame on_frame_;
  OnEnd on_end_;
};

}  // namespace

Result<std::unique_ptr<Source>> OpenVideo(boost::asio::io_context& io, const std::string& device,
                                          const frames::CameraFile& camera,
                                          const VideoSettings& settings,
                                          std::function<void(const std::string&)> alarm) {
  const int descriptor = ::open(device.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) {
    return NoDevice("cannot open " + device + ": " + std::strerror(errno) +
                    "; is the camera plugged in, and are you in the group video?");
  }
  auto probe = v4l2_capability{};
  if (KernelPort(descriptor).Control(VIDIOC_QUERYCAP, &probe) != 0) {
    ::close(descriptor);
    return NoDevice(device + " is not a camera");
  }
  auto source = std::make_unique<VideoSource>(io, descriptor, camera, settings, std::move(alarm));
  if (const auto opened = source->Open(); !opened) return opened.error();
  return std::unique_ptr<Source>(std::move(source));
}

}  // namespace footing::camera
