#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "daemon/offline/pose_run/held_hands.h"
#include "daemon/simulation/pose/hand_attitude.h"

namespace footing::eval {

/// A device in one fist, reading for reading: where it truly is, and what it measures.
struct HandCourse {
  double rate_hz = 0;
  Eigen::Matrix3Xd p_W_m, v_W_mps;
  std::vector<Eigen::Matrix3d> R_WS;
  std::vector<arms::HandReading> readings;

  Eigen::Index count() const { return p_W_m.cols(); }
  /// Of a quantity at a time within the course.
  Eigen::Vector3d At(const Eigen::Matrix3Xd& values, double time_s) const;
  /// Where a point of the device is.
  Eigen::Vector3d PointAt(const Eigen::Vector3d& p_SP_m, double time_s) const;

 private:
  /// The reading before a time, and the share of the way to the next one.
  struct Between {
    Eigen::Index before;
    double share;
  };
  Between Find(double time_s) const;
};

/// Of side 0 (left) or 1, at the rate of a PS Move, with errors as of a Wiimote (held_device.h).
HandCourse FollowHand(const pose_run::ArmRun& run, int side, std::uint64_t seed);

}  // namespace footing::eval
