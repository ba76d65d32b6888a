#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "daemon/simulation/pose/hand_attitude.h"
#include "daemon/simulation/pose/inertial_filter.h"

namespace footing::inertial {

/// Where a hand is that a tracker sees now and then, late, and whose device measures acceleration
/// and turn all the time: Filter with readings and observations that arrive at their own
/// times. It bridges the gaps between observations and refuses one that the readings contradict.
/// A value.
class Track {
 public:
  static constexpr double kBridgedS = 0.6;  ///< Without an observation nothing is valid later.
  static constexpr double kGapS = 0.1;      ///< Without readings it starts again.

  struct State {
    bool valid = false;
    Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();  ///< Position of the device.
    Eigen::Vector3d v_W_mps = Eigen::Vector3d::Zero();
    /// Covariance of place and velocity.
    Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Identity();
  };

  /// `p_SP_m`: of the point that is tracked, from the device's accelerometer.
  explicit Track(const Eigen::Vector3d& p_SP_m = Eigen::Vector3d::Zero());

  /// A reading of the device. Times are those of one clock; one that is not later than the last
  /// counts for nothing, one from a second before it is of another clock: everything starts again.
  /// Non-finite readings are left out.
  void Feel(double time_s, const arms::HandReading& reading);
  /// An observation, exposed then. It counts as soon as readings reach its time, and not at all
  /// when it is 0.15 s older than they are, or older than the last one that counted.
  void See(double time_s, const Filter::Observation& seen);

  /// Place and velocity at that time. Invalid before the first half second of readings and before a
  /// motion that was seen has shown the heading, when the last observation that counted is older
  /// than kBridgedS, and when readings are older than kGapS.
  State At(double time_s) const;

  std::size_t taken() const { return taken_; }      ///< Observations that counted,
  std::size_t refused() const { return refused_; }  ///< and that the readings contradict.

 private:
  struct Timed {
    double time_s;
    arms::HandReading reading;
  };
  struct Waiting {
    double time_s;
    Filter::Observation seen;
  };
  /// The filter at the time of a reading.
  struct Point {
    Filter filter;
    Timed last;
    void AdvanceTo(const Timed& next);
  };

  void Restart();
  void FeelGravity(const arms::HandReading& reading, double step_s);
  static arms::HandReading Between(const Timed& a, const Timed& b, double time_s);
  /// Through the readings, up to that time.
  static void AdvanceThrough(const std::vector<Timed>& readings, double time_s, Point& point);
  void Apply(const Waiting& one);
  bool FollowsTheLast(const Waiting& one) const;
  bool IsLost();
  bool Start(const Waiting& one);
  double SpreadMps2() const;  ///< Standard deviation of the felt force.
  void DropBefore(double time_s);

  Eigen::Vector3d p_SP_m_;
  std::vector<Timed> readings_;  ///< Those after the base, and some before it.
  std::vector<Waiting> waiting_;
  bool started_ = false;
  Point base_;
  double taken_s_ = 0;      ///< Time of the last observation that counted,
  double started_s_ = 0;    ///< and of the one that it started with.
  Waiting last_seen_ = {};  ///< Whether it counted or not.
  int contradictions_ = 0;  ///< Since one counted,
  bool jumped_ = false;     ///< and whether what is seen has jumped since.
  std::size_t taken_ = 0, refused_ = 0;
  // For a start: the mean force in the frame that the gyroscope keeps.
  Eigen::Matrix3d R_GS_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d force_sum_ = Eigen::Vector3d::Zero();
  double square_sum_ = 0, felt_s_ = 0;
};

}  // namespace footing::inertial
