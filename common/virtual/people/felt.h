#pragma once

#include <Eigen/Core>
#include <array>

#include "common/stream/device.h"
#include "common/virtual/devices/ground_reaction.h"

namespace footing::users {

/// What one Wiimote on the body feels, in its frame S, m/s2.
struct FeltRemote {
  stream::DeviceRole role = stream::DeviceRole::kUnspecified;
  Eigen::Vector3d specific_force_S_mps2 = Eigen::Vector3d::Zero();
};

/// What all devices of an interface feel; those that it does not have stay as they are here.
struct Felt {
  std::array<FeltRemote, 3> remotes;
  int remote_count = 0;
  double stick_x = 0;  ///< -1 left to 1 right.
  double stick_y = 0;  ///< -1 back to 1 front.
  bool button_a = false;
  /// Under the left and the right foot, in W with the origin between the boards.
  std::array<virtual_sensors::FootForce, 2> feet;
};

}  // namespace footing::users
