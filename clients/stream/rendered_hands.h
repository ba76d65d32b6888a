#pragma once

#include <memory>
#include <string>

#include "clients/stream/body_stage.h"
#include "clients/stream/plan.h"
#include "common/frames/camera_file.h"
#include "common/base/result.h"

namespace footing::stream_client {

/// Frames of a simulated camera in front of the body, with a luminous sphere in the middle of each
/// fist, for footing-camera: PGM images, each with the time of its exposure on the host's monotonic
/// clock. They are rendered in a thread of their own, since that takes longer than a report may
/// wait; a frame that is due while one is rendered is left out. `fifo` is opened for writing,
/// which waits for its reader. The camera file must say where the camera is. A sphere has the
/// file's colour, or that of the light of the PS Move in its fist.
Result<Feed> RenderedHandsFeed(std::shared_ptr<const Stage> stage, const std::string& camera_file,
                               const std::string& fifo, std::uint64_t seed);

/// A camera file for it: 2.2 m in front of the boards, 20 frames a second.
std::string DemoCameraFile();

}  // namespace footing::stream_client
