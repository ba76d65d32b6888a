#pragma once

#include <linux/videodev2.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "clients/camera/source.h"
#include "common/base/result.h"

namespace footing::camera {

/// The kernel's side of a camera, so that a test can take its place.
class VideoPort {
 public:
  virtual ~VideoPort() = default;
  /// An ioctl; 0, or the errno.
  virtual int Control(unsigned long request, void* argument) = 0;
};

/// Asks for the camera file's format, size and rate; an error names the format and size that the
/// driver gave instead. A driver may keep its own rate.
Result<void> Negotiate(VideoPort& port, const frames::CameraFile& camera);

/// Switches automatic exposure, gain and white balance off, sets exposure and gain, and reads all
/// back. Each line says what the camera does not have or ignored, and what that does to the
/// measurement; empty when all is locked.
std::vector<std::string> LockControls(VideoPort& port, const VideoSettings& settings);

/// Watches the controls that were locked: a driver may lose them, and another program may change
/// them, while frames arrive.
class LockedControls {
 public:
  /// Those that hold now.
  LockedControls(VideoPort& port, const VideoSettings& settings);

  /// Reads all back, and sets again what has changed. Each line names a control that has changed
  /// since the last call, and whether it could be set again; empty when all hold.
  std::vector<std::string> Check();

 private:
  struct Watched {
    std::uint32_t id;
    std::int32_t value;
    std::string name, harm;
    bool holds;
  };
  VideoPort& port_;
  std::vector<Watched> watched_;
};

/// Mid-exposure of the middle row of a dequeued buffer, ns of the monotonic clock; `now_ns` where
/// the driver's stamp is not of that clock. A driver stamps the end of the readout, or the start of
/// the exposure where its flags say so.
std::int64_t ExposedNs(const v4l2_buffer& buffer, const frames::CameraFile& camera,
                       double exposure_s, std::int64_t now_ns);

}  // namespace footing::camera
