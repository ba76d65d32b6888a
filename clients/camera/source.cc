#include "clients/camera/source.h"

#include <utility>

namespace footing::camera {

Result<std::unique_ptr<Source>> OpenFrames(boost::asio::io_context& io, const FrameOptions& options,
                                           const frames::CameraFile& camera,
                                           std::function<void(const std::string&)> alarm) {
  if (!options.folder.empty()) return OpenFolder(io, options.folder, camera, options.repeats);
  if (!options.pipe.empty()) return OpenPipe(io, options.pipe, options.pipe_settings);
  return OpenVideo(io, options.device, camera, options.video, std::move(alarm));
}

}  // namespace footing::camera
