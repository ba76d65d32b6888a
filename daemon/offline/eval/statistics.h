#pragma once

#include "daemon/simulation/engine/engine.h"

namespace footing::eval {

/// Root of a mean of squares, built up value by value.
struct RootMeanSquare {
  double sum = 0;
  std::uint64_t count = 0;

  void Add(double value);
  double value() const;
};

/// Heading of a body's x axis, rad.
double YawOf(const Eigen::Quaterniond& q);

/// What is measured of settled locomotion.
///
/// Speed errors are those of the mean speed over successive seconds, since the speed within one
/// step rises and falls by nature. The apex is that of the COM over its height at lift-off.
class GaitStatistics {
 public:
  explicit GaitStatistics(double commanded_speed_mps) : commanded_mps_(commanded_speed_mps) {}

  void Add(const engine::EngineOutput& output, double step_s);

  double speed_mean_mps() const { return time_s_ > 0 ? distance_m_ / time_s_ : 0; }
  double speed_error_rms_mps() const { return speed_error_.value(); }
  double heading_error_rms_rad() const { return heading_error_.value(); }
  double apex_height_m() const { return hops_ > 0 ? apex_sum_m_ / hops_ : 0; }

 private:
  void AddApex(const engine::EngineOutput& output);

  double commanded_mps_;
  double time_s_ = 0;
  double distance_m_ = 0;
  double window_s_ = 0;
  double window_m_ = 0;
  RootMeanSquare speed_error_;
  RootMeanSquare heading_error_;
  bool in_flight_ = false;
  bool flight_known_ = false;  ///< This flight was seen from its lift-off.
  double lift_off_m_ = 0;
  double apex_m_ = 0;
  double apex_sum_m_ = 0;
  int hops_ = 0;
};

}  // namespace footing::eval
