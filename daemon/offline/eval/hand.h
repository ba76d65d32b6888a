#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "daemon/offline/eval/report.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/simulation/pose/hand_attitude.h"

namespace footing::eval {

/// Times for which the camera sees and loses a hand, and errors of the devices.
struct HandTrialOptions {
  std::vector<double> hidden_s = {0.1, 0.25, 0.5};
  double seen_s = 2;
  double sphere_m = 0;      ///< From the device's sensors along its x.
  double lamp_m = 0;        ///< Above a hidden hand; 0: none.
  double common_share = 0;  ///< Share of the camera's variance that all frames have in common.
  std::uint64_t seed = 1;
};

/// Both hands of a motion before a camera 2.2 m ahead of the person, with errors and delays as
/// docs/evaluation/camera.md has measured them: errors at each tick of reconstruction::HandTrack,
/// from the camera alone, and of inertial::Track.
nlohmann::ordered_json RunHandTrial(const pose_run::ArmRun& run, const HandTrialOptions& options);

/// footing-eval hand: where a tracked hand is between frames and while it is hidden.
void AddHandCommand(CLI::App& app, Shared& shared);

/// A device in one fist, reading for reading: where it truly is, and what it measures.
struct HandCourse {
  double rate_hz = 0;
  Eigen::Matrix3Xd p_W_m, v_W_mps;
  std::vector<Eigen::Matrix3d> R_WS;
  std::vector<arms::HandReading> readings;

  Eigen::Index count() const { return p_W_m.cols(); }
  /// Value of a quantity (a column a time) at a time within the course.
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

/// Course of the hand on side 0 (left) or 1, at a PS Move's rate, with a Wiimote's errors
/// (held_device.h).
HandCourse FollowHand(const pose_run::ArmRun& run, int side, std::uint64_t seed);

}  // namespace footing::eval
