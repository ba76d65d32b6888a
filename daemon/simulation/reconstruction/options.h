#pragma once

#include "common/base/result.h"
#include "daemon/simulation/pose/gauss_newton.h"
#include "daemon/simulation/reconstruction/feet.h"

namespace footing::reconstruction {

enum class Mode { kBest, kPaper };

/// Standard deviations and weights of the best mode's terms.
struct BestConstants {
  double hand_sd_m = 0.008;  ///< Of the fist on the hand, beside what the input says.
  double arm_spread = 1.5;   ///< Factor on an arm's deviations: its errors persist for many frames.
  /// Of the belt on the pelvis, about each axis, beside what the attitude says.
  double belt_sd_rad = 0.07;
  FootSpread foot;
  double com_sd_m = 0.005;  ///< Of the masses, beside what the filters say.
  /// kg m^2/s, beside what the estimate says; 0: the angular momentum is left out, since as it is
  /// estimated it helps no pose (docs/pose.md).
  double angular_sd = 0;
  double prior_weight = 0.6;
  double smooth_weight = 1;             ///< At 60 Hz.
  double regressed_prior_weight = 0.6;  ///< The same about the regression's pose.
  double regressed_smooth_weight = 1;
  /// Factor on the deviations of the linearised terms, whose errors persist for many frames.
  double spread = 1.4;
  double arm_joint_spread = 1.15;  ///< The same from the shoulders down: hands are measured.
  double com_spread = 1.75;        ///< The same for the height of the COM.
  /// What the covariance of all frames leaves out of the knee and what is below it while the foot
  /// is in the air: m along one axis, reached with this time constant.
  double aloft_sd_m = 0.14;
  double aloft_time_s = 0.2;
};

struct Options {
  Mode mode = Mode::kBest;
  double rate_hz = 120;  ///< Frames a second.
  double lag_s = 0;      ///< 0 to 0.2: poses are reported with this delay, and are better.
  bool use_momentum = true;
  bool use_angular_momentum = true;
  /// Of the best mode: the momentum's filters take where hands and feet alone place the COM.
  bool use_posture = true;
  bool clean_up = true;
  bool use_basis = true;
  BestConstants best;

  double step_s() const { return 1 / rate_hz; }
  int lag_steps() const;
};

Result<void> CheckOptions(const Options& options);

/// Of the solver over the basis of all poses, and over the errors of the regression.
pose::GaussNewtonOptions BasisSolverOptions(const Options& options);
pose::GaussNewtonOptions RegressedSolverOptions(const Options& options);
/// Of hands and feet alone.
pose::GaussNewtonOptions PostureSolverOptions(const Options& options);

}  // namespace footing::reconstruction
