#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "common/stream/gait.h"
#include "common/stream/track.h"
#include "common/stream/trial.h"

namespace footing::stream {

struct Link {
  std::string name;
  int parent = -1;
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();  ///< Full extents, centred on the link's frame.
};

struct Skeleton {
  std::uint32_t character = 0;
  std::string name;
  std::vector<Link> links;
  std::vector<std::string> contact_points;
};

struct LinkPose {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

struct Contact {
  bool touching = false;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  double normal_force_n = 0;
};

struct GaitState {
  Gait gait = Gait::kStep;
  Gait commanded_gait = Gait::kStep;
  bool pending = false;
  const char* phase = "";  ///< A string of static storage.
  double commanded_speed_mps = 0;
  double commanded_height_m = 0;
  double commanded_turn_rad = 0;
  double speed_mps = 0;
  double heading_rad = 0;
  std::uint64_t steps = 0;
  std::uint64_t falls = 0;  ///< Failures of every cause.
  FailureCounts failures;
  std::uint64_t operator_put_backs = 0;  ///< By a command while it stood: not a failure.
  double distance_m = 0;
  bool commanded_by_stream = false;
  Eigen::Vector2d next_foothold_m = Eigen::Vector2d::Zero();
};

}  // namespace footing::stream
