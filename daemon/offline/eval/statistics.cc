#include "daemon/offline/eval/statistics.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::eval {
namespace {

constexpr double kWindowS = 1.0;

}  // namespace

double YawOf(const Eigen::Quaterniond& q) {
  const Eigen::Vector3d ahead = q * Eigen::Vector3d::UnitX();
  return std::atan2(ahead.y(), ahead.x());
}

void RootMeanSquare::Add(double value) {
  sum += value * value;
  ++count;
}

double RootMeanSquare::value() const {
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

void GaitStatistics::Add(const engine::EngineOutput& output, double step_s) {
  const double moved_m = output.gait.speed_mps * step_s;
  time_s_ += step_s;
  distance_m_ += moved_m;
  window_s_ += step_s;
  window_m_ += moved_m;
  if (window_s_ >= kWindowS) {
    speed_error_.Add(window_m_ / window_s_ - commanded_mps_);
    window_s_ = window_m_ = 0;
  }
  heading_error_.Add(WrapAngle(YawOf(output.links[0].orientation) - output.gait.heading_rad));
  AddApex(output);
}

void GaitStatistics::AddApex(const engine::EngineOutput& output) {
  const bool flying = !output.contacts[0].touching && !output.contacts[1].touching;
  const double height_m = output.p_WC_m.z();
  const bool lifts_off = flying && !in_flight_;
  const bool lands = !flying && in_flight_;
  if (lifts_off) {
    lift_off_m_ = apex_m_ = height_m;
    flight_known_ = time_s_ > 0.1;
  }
  apex_m_ = std::max(apex_m_, height_m);
  constexpr double kShortestHopM = 0.01;  // Less is a foot that chatters.
  if (lands && flight_known_ && apex_m_ - lift_off_m_ > kShortestHopM) {
    apex_sum_m_ += apex_m_ - lift_off_m_;
    ++hops_;
  }
  in_flight_ = flying;
}

}  // namespace footing::eval
