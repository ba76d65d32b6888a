#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

namespace footing::stream {

enum class Gait { kUnspecified = 0, kStep = 1, kWalk = 2, kRun = 3, kJump = 4 };

/// "step", "walk", "run", "jump".
const char* Name(Gait gait);
/// The gait of that name; kUnspecified when there is none.
Gait GaitNamed(const std::string& name);

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

/// A piece of ground; start is the middle of the top face's near edge.
struct TrackSegment {
  Eigen::Vector3d start_m = Eigen::Vector3d::Zero();
  double heading_rad = 0;
  double slope_rad = 0;
  double length_m = 0;
  double width_m = 0;
  bool pit = false;
};

struct Track {
  std::string name;
  std::vector<TrackSegment> segments;
  std::uint64_t revision = 0;  ///< Counts up with every change.
  bool open = false;           ///< One may leave the ribbon; otherwise that is a failure.
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
  std::uint64_t falls = 0;
  double distance_m = 0;
  bool commanded_by_stream = false;
  Eigen::Vector2d next_foothold_m = Eigen::Vector2d::Zero();
};

}  // namespace footing::stream
