#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <linux/videodev2.h>
#include <CLI/CLI.hpp>
#include <boost/asio/io_context.hpp>

#include "common/base/result.h"
#include "common/camera/fit_lens.h"
#include "common/frames/camera_file.h"

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

/// Settings of OpenPipe(). A frame's exposure is when its last byte arrived less `latency_s`, or,
/// where frames are `stamped`, the time that its comment states on the host's monotonic clock.
struct PipeSettings {
  double latency_s = 0;
  bool stamped = false;
};
/// PGM and PPM images one after the other from a FIFO, or from standard input ("-").
Result<std::unique_ptr<Source>> OpenPipe(boost::asio::io_context& io, const std::string& path,
                                         const PipeSettings& settings);

/// Controls to which OpenVideo() locks a camera.
struct VideoSettings {
  double exposure_s = 0.004;
  int gain = -1;  ///< Gain in the driver's own scale; -1 leaves it as it is.
};
/// A camera by V4L2: `device` is a path as /dev/video0. Exposure, gain and white balance are locked
/// to the values given and read back; a camera that ignores one is reported by `alarm`.
Result<std::unique_ptr<Source>> OpenVideo(boost::asio::io_context& io, const std::string& device,
                                          const frames::CameraFile& camera,
                                          const VideoSettings& settings,
                                          std::function<void(const std::string&)> alarm);

/// Fails when a frame is not of the size of the camera file.
Result<void> CheckSize(const frames::Frame& frame, const frames::CameraFile& camera);

/// Where frames come from, as a command line names it.
struct FrameOptions {
  std::string device, folder, pipe;  ///< Exactly one is set.
  VideoSettings video;
  PipeSettings pipe_settings;
  bool repeats = false;  ///< Plays a folder again and again.

  const std::string& Name() const {
    return !folder.empty() ? folder : !pipe.empty() ? pipe : device;
  }
};
/// Opens the source that the options name.
Result<std::unique_ptr<Source>> OpenFrames(boost::asio::io_context& io, const FrameOptions& options,
                                           const frames::CameraFile& camera,
                                           std::function<void(const std::string&)> alarm);

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

/// Options common to all commands of footing-camera.
struct CommandLine {
  std::string camera_file;
  FrameOptions frames;
  bool json = false, quiet = false;
};

/// Adds these options to a command.
void AddCommandLine(CLI::App& app, CommandLine& line);

/// A usage error unless a camera file and one source of frames are named.
Result<void> Check(const CommandLine& line);

/// A camera's exposure is the command line's; that of other frames is the camera file's.
void ApplyExposure(const CommandLine& line, frames::CameraFile& camera);

/// footing-camera calibrate and lens; `exit_code` is set when one has run.
void AddCalibrateCommand(CLI::App& app, int& exit_code);
void AddLensCommand(CLI::App& app, int& exit_code);

/// Options of a lens calibration.
struct LensOptions {
  frames::CameraFile camera;  ///< Its size and format are those of the frames.
  FrameOptions frames;
  int views = 12;
  double seconds = 300;  ///< After that the views so far are used.
};

/// Result of a lens calibration.
struct LensReport {
  lens_calibration::LensFit fit;
  std::size_t frames = 0, views = 0;
};

/// Guides a person, by lines of the log, who moves a sheet of dots before the camera, and fits the
/// lens to what was seen.
Result<LensReport> MeasureLens(const LensOptions& options);

}  // namespace footing::camera
