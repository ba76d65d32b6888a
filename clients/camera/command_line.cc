#include "clients/camera/command_line.h"

namespace footing::camera {

void AddCommandLine(CLI::App& app, CommandLine& line) {
  FrameOptions& frames = line.frames;
  app.add_option("--camera", line.camera_file, "Camera file, JSON (docs/camera.md)");
  app.add_option("--device", frames.device, "Camera, such as /dev/video0");
  app.add_option("--frames", frames.folder, "Folder of frames: .pgm, .ppm or .yuyv files");
  app.add_option("--fifo", frames.pipe,
                 "FIFO of PGM or PPM images, one after the other; - for standard input");
  app.add_option("--exposure-s", frames.video.exposure_s, "Exposure time of a camera, s")
      ->check(CLI::Range(0.0001, 1.0));
  app.add_option("--gain", frames.video.gain,
                 "Gain of a camera, on its own scale (-1: leave unchanged)")
      ->check(CLI::Range(-1, 100000));
  app.add_option("--latency-s", frames.pipe_settings.latency_s,
                 "Time from the exposure of a FIFO's frame to its last byte, s")
      ->check(CLI::Range(0.0, 1.0));
  app.add_flag(
      "--stamped", frames.pipe_settings.stamped,
      "Take a FIFO frame's exposure from its comment # time_ns, of the host's monotonic clock");
  app.add_flag("--repeat", frames.repeats, "Play the frames of a folder again and again");
  app.add_flag("--json", line.json, "One JSON object on standard output, at the end");
  app.add_flag("-q,--quiet", line.quiet, "Log only warnings and errors");
}

Result<void> Check(const CommandLine& line) {
  if (line.camera_file.empty()) return UsageError("--camera FILE is missing (docs/camera.md)");
  const FrameOptions& frames = line.frames;
  if (frames.device.empty() + frames.folder.empty() + frames.pipe.empty() != 2)
    return UsageError("name one of --device, --frames and --fifo");
  return {};
}

void TakeExposure(const CommandLine& line, frames::CameraFile& camera) {
  if (!line.frames.device.empty())
    camera.settings.shutter.exposure_s = line.frames.video.exposure_s;
}

}  // namespace footing::camera
