#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/offline/learning/force_trace.h"
#include "daemon/simulation/momentum/calibration.h"
#include "daemon/simulation/momentum/contact_loads.h"

namespace footing::learning {

/// Top left, top right, bottom left, bottom right, N; as virtual_sensors::Corners.
struct BoardReading {
  double time_s = 0;
  std::array<double, 4> corners_n{};
};

struct HandReading {
  double time_s = 0;
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d sd_m = Eigen::Vector3d::Zero();
};

/// What two boards and two hand trackers measured of one person, in the order of time from the
/// first reading of a board on. 0 is left.
struct RecordedSession {
  std::string name;  ///< Of the file.
  std::array<std::vector<BoardReading>, 2> boards;
  std::array<std::array<Eigen::Vector2d, 4>, 2> cells_W_m;  ///< Places of the corners' sensors.
  std::array<std::vector<HandReading>, 2> hands;            ///< May be empty.
  double duration_s = 0;
};

/// Longer without a reading, a board says nothing, or a hand is not seen: as live.
inline constexpr double kBoardSilenceS = 0.2;
inline constexpr double kHandSilenceS = 0.15;

/// Between the readings before and after; a board is not valid in a silence.
momentum::ContactLoads LoadsAt(const RecordedSession& session, double time_s);
/// The same; nothing while the hand is not seen.
std::optional<HandReading> HandAt(const RecordedSession& session, std::size_t side, double time_s);

/// The first T-pose that a live calibration would have taken.
std::optional<momentum::TPose> FindTPose(const RecordedSession& session);

/// Of a person of this weight, 100 a second.
ForceTrace TraceOf(const RecordedSession& session, double weight_n);

}  // namespace footing::learning
