#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/body/landmarks.h"
#include "common/virtual/motion/motion.h"
#include "daemon/simulation/momentum/calibration.h"
#include "daemon/simulation/momentum/contact_loads.h"

namespace footing::learning {

/// The vertical force under each foot of somebody at equal steps, whoever measured it: boards under
/// the feet, or inverse dynamics of a recorded motion.
struct ForceTrace {
  std::string name;      ///< Name of its file, for errors.
  double rate_hz = 100;  ///< Time 0 is the first column.
  double weight_n = 0;   ///< Weight of the person.
  Eigen::Matrix2Xd load_n;
  std::vector<bool> valid;  ///< A column each: false where nothing was measured (loads are held).

  double duration_s() const { return static_cast<double>(load_n.cols()) / rate_hz; }
  /// The sum of both feet in parts of the weight, low-passed without lag.
  Eigen::VectorXd Total(double cutoff_hz) const;
};

/// A stomp: a short push over the weight (kStompOver and more) within kUnloadedS of a foot that
/// bore less than kUnloadedShare. Landings of jumps and steps are like it.
struct Stomp {
  double time_s = 0;
  double over = 0;  ///< Parts of the weight over it, low-passed at kStompCutoffHz.
};
inline constexpr double kStompCutoffHz = 8;
inline constexpr double kStompOver = 0.12;
inline constexpr double kStompLongestS = 0.3;  ///< Over half of its push.
inline constexpr double kUnloadedShare = 0.1;
inline constexpr double kUnloadedS = 0.4;

/// In the order of time, at least a quarter of a second apart: of closer ones the stronger.
std::vector<Stomp> FindStomps(const ForceTrace& trace);

/// How the clock of a recording goes beside that of a motion: recording = offset_s + (1 + drift)
/// motion, both counted from the first columns of their traces.
struct TimeAlignment {
  double offset_s = 0;
  double drift = 0;        ///< Positive: the recording's clock is the faster one.
  double residual_s = 0;   ///< Root mean square of what is left, between pieces of eight seconds,
  int pieces = 0;          ///< of which there are so many; one or two say nothing of it.
  double correlation = 0;  ///< Correlation of the vertical forces, where both are.
  double overlap_s = 0;
  int stomps_recording = 0, stomps_motion = 0;
  int stomps_both = 0;  ///< Found in both, within 50 ms of each other.

  double ToRecording(double motion_s) const { return offset_s + (1 + drift) * motion_s; }
  double ToMotion(double recording_s) const { return (recording_s - offset_s) / (1 + drift); }
};

/// Stomps vote for the offset: where three and more of one have the intervals of the other's, the
/// forces are correlated over all that both have, and the best is kept. Then pieces of eight
/// seconds are moved until each correlates best, and a line through their lags is the offset and
/// the drift. Clocks are quartz: the drift is held to 0 with kDriftSd, which only matters where a
/// recording is too short to estimate.
///
/// InvalidData: fewer than three stomps in one of them, none that go together, or forces that do
/// not (a correlation under kLeastCorrelation).
Result<TimeAlignment> AlignInTime(const ForceTrace& recorded, const ForceTrace& moved);

inline constexpr double kDriftSd = 100e-6;
inline constexpr double kLeastCorrelation = 0.7;  ///< Plates under drop jumps have 0.94.
inline constexpr int kFewestStomps = 3;

/// The motion turned and moved as a whole: facing x (the mean of right to left hip is y), the
/// median middle of the feet over the origin, and the floor at z = 0 (the lowest of the toes lies
/// 1.5 cm above it in all but 2 % of the frames, which lie lower). Angles are unwrapped: none jumps
/// by more than half a turn from one frame to the next.
motion::Motion Aligned(const motion::Motion& motion, const body::Landmarks& landmarks);

/// text::Quantile of a vector, which must not be empty.
double Quantile(const Eigen::VectorXd& values, double share);

/// Top left, top right, bottom left, bottom right, N; as virtual_sensors::Corners.
struct BoardReading {
  double time_s = 0;
  std::array<double, 4> corners_n{};
};

/// A tracked hand's place in W, with its standard deviation.
struct HandReading {
  double time_s = 0;
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d sd_m = Eigen::Vector3d::Zero();
};

/// Measurements of one person by two boards and two hand trackers, in the order of time from the
/// first reading of a board on. 0 is left.
struct RecordedSession {
  std::string name;  ///< Name of the file.
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

/// Forces measured by the boards in a session of a person of this weight, 100 columns a second.
ForceTrace TraceOf(const RecordedSession& session, double weight_n);

}  // namespace footing::learning
