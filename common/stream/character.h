#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace footing::stream {

enum class Gait { kUnspecified = 0, kStep = 1, kWalk = 2, kRun = 3, kJump = 4 };

/// All gaits, in the order of their numbers: what has a place for each gait is as long as this.
inline constexpr std::array kGaits{Gait::kStep, Gait::kWalk, Gait::kRun, Gait::kJump};

/// A gait's place in kGaits; kUnspecified has the first.
constexpr std::size_t IndexOf(Gait gait) {
  for (std::size_t i = 0; i < kGaits.size(); ++i) {
    if (kGaits[i] == gait) return i;
  }
  return 0;
}

/// The gait of a number of the protocol; kUnspecified for one that is not known.
constexpr Gait GaitNumbered(int number) {
  for (const Gait gait : kGaits) {
    if (static_cast<int>(gait) == number) return gait;
  }
  return Gait::kUnspecified;
}

/// "step", "walk", "run", "jump".
const char* Name(Gait gait);
/// The gait of that name; kUnspecified when there is none.
Gait GaitNamed(const std::string& name);
/// "step, walk, run, jump": for errors.
std::string GaitNames();

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
  bool extendable = false;     ///< Segments may be added at the end while a character is on it.
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

/// Failures by cause, as the gait paper counts them (section 8.2).
struct FailureCounts {
  std::uint64_t simulation = 0;  ///< The character fell on ground that it could stand on.
  std::uint64_t curve = 0;       ///< It left the ribbon.
  std::uint64_t jump = 0;        ///< A foot went into a pit.

  friend bool operator==(const FailureCounts&, const FailureCounts&) = default;
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
  std::uint64_t falls = 0;  ///< Failures of every cause and operator put-backs.
  FailureCounts failures;
  std::uint64_t operator_put_backs = 0;  ///< By a command while it stood: not a failure.
  double distance_m = 0;
  bool commanded_by_stream = false;
  Eigen::Vector2d next_foothold_m = Eigen::Vector2d::Zero();
};

}  // namespace footing::stream
