#pragma once

#include <memory>

#include "clients/view/scene/camera.h"

namespace footing::scene::made {

/// Picture of a camera of 640 x 480: surroundings in dim blue, the left hand's sphere in magenta,
/// seen; the right hand's being checked; a lamp that was refused.
inline CameraPreview Preview(std::int64_t exposed_ns) {
  preview::Picture picture;
  picture.number = 42;
  picture.exposed_ns = exposed_ns;
  picture.camera_width = 640;
  picture.camera_height = 480;
  picture.has_pose = true;
  picture.width = 320;
  picture.height = 240;
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      const bool ball = (u - 90) * (u - 90) + (v - 110) * (v - 110) < 12 * 12;
      picture.rgb.push_back(ball ? 230 : 20);
      picture.rgb.push_back(ball ? 60 : 30);
      picture.rgb.push_back(ball ? 200 : 60);
    }
  }
  picture.spheres = {{stream::DeviceRole::kLeftHand,
                      preview::Sight::kSeen,
                      false,
                      false,
                      0.97f,
                      1.52f,
                      {180, 220, 24}},
                     {stream::DeviceRole::kRightHand,
                      preview::Sight::kChecking,
                      false,
                      false,
                      0.9f,
                      1.4f,
                      {420, 260, 22}}};
  picture.refused = {{stream::DeviceRole::kRightHand, {520, 90, 18}}};
  CameraPreview shown;
  shown.state = CameraPreview::State::kShown;
  shown.address = "unix:/run/user/1000/footing/camera.sock";
  shown.picture = std::make_shared<const preview::Picture>(std::move(picture));
  return shown;
}

}  // namespace footing::scene::made
