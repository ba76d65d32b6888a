#include "clients/camera/source.h"

#include <utility>

namespace footing::camera {

namespace {

std::string Size(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace

Result<void> CheckSize(const frames::Frame& frame, const frames::CameraFile& camera) {
  if (frame.width == camera.lens.width && frame.height == camera.lens.height) return {};
  return InvalidData("a frame has " + Size(frame.width, frame.height) +
                     " pixels, but the camera file is for " +
                     Size(camera.lens.width, camera.lens.height) +
                     "; set the camera to that size, or measure its lens again (footing-camera "
                     "lens)");
}

Result<std::unique_ptr<Source>> OpenFrames(boost::asio::io_context& io, const FrameOptions& options,
                                           const frames::CameraFile& camera,
                                           std::function<void(const std::string&)> alarm) {
  if (!options.folder.empty()) return OpenFolder(io, options.folder, camera, options.repeats);
  if (!options.pipe.empty()) return OpenPipe(io, options.pipe, options.pipe_settings);
  return OpenVideo(io, options.device, camera, options.video, std::move(alarm));
}

}  // namespace footing::camera
