#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>

#include "common/frames/camera_file.h"
#include "common/frames/frame.h"
#include "common/base/result.h"

namespace footing::camera {

/// Where frames come from; everything runs on the io_context's thread.
class Source {
 public:
  /// A frame, and the mid-exposure of its middle row on the host's monotonic clock.
  using OnFrame = std::function<void(const frames::Frame& frame, std::int64_t exposed_ns)>;
  /// No more frames: the end, or an error.
  using OnEnd = std::function<void(Result<void> end)>;

  virtual ~Source() = default;
  virtual void Start(OnFrame on_frame, OnEnd on_end) = 0;
  virtual void Stop() = 0;
};

/// The frames of a folder at the camera file's rate, again and again when `repeats`.
Result<std::unique_ptr<Source>> OpenFolder(boost::asio::io_context& io, const std::string& folder,
                                           const frames::CameraFile& camera, bool repeats);

/// PGM and PPM images one after the other from a FIFO, or from standard input ("-"). A frame's
/// exposure is when its last byte arrived less `latency_s`, or, where frames are `stamped`, the
/// time that its comment states on the host's monotonic clock.
struct PipeSettings {
  double latency_s = 0;
  bool stamped = false;
};
Result<std::unique_ptr<Source>> OpenPipe(boost::asio::io_context& io, const std::string& path,
                                         const PipeSettings& settings);

/// A camera by V4L2: `device` is a path as /dev/video0. Exposure, gain and white balance are locked
/// to the values given and read back; a camera that ignores one is reported by `alarm`.
struct VideoSettings {
  double exposure_s = 0.004;
  int gain = -1;  ///< Of the driver's own scale; -1 leaves it as it is.
};
Result<std::unique_ptr<Source>> OpenVideo(boost::asio::io_context& io, const std::string& device,
                                          const frames::CameraFile& camera,
                                          const VideoSettings& settings,
                                          std::function<void(const std::string&)> alarm);

/// Fails when a frame is not of the size of the camera file.
Result<void> CheckSize(const frames::Frame& frame, const frames::CameraFile& camera);

/// Where frames come from, as a command line names it.
struct FrameOptions {
  std::string device, folder, pipe;  ///< One of them.
  VideoSettings video;
  PipeSettings pipe_settings;
  bool repeats = false;  ///< Of a folder.

  const std::string& Name() const {
    return !folder.empty() ? folder : !pipe.empty() ? pipe : device;
  }
};
Result<std::unique_ptr<Source>> OpenFrames(boost::asio::io_context& io, const FrameOptions& options,
                                           const frames::CameraFile& camera,
                                           std::function<void(const std::string&)> alarm);

}  // namespace footing::camera
