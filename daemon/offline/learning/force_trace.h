#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace footing::learning {

/// The vertical force under each foot of somebody at equal steps, whoever measured it: boards under
/// the feet, or inverse dynamics of a recorded motion.
struct ForceTrace {
  std::string name;      ///< Of its file, for errors.
  double rate_hz = 100;  ///< Time 0 is the first column.
  double weight_n = 0;   ///< Of the person.
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

}  // namespace footing::learning
