#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "common/base/units.h"
#include "common/virtual/devices/noise.h"
#include "daemon/simulation/momentum/best_estimator.h"
#include "daemon/simulation/momentum/calibration.h"
#include "daemon/simulation/momentum/contact_loads.h"
#include "daemon/simulation/momentum/contacts.h"

namespace footing::momentum {

inline constexpr double kMadeStepS = 1 / 60.0;
inline constexpr double kMadeMassKg = 70;
inline constexpr double kMadeHeightM = 1.0;
inline constexpr double kHalfLengthM = 0.2165;  ///< Half the distance of a board's sensors in x.
inline constexpr double kHalfWidthM = 0.119;
inline constexpr double kBoardYM = 0.16;

/// A point mass that moves as it is told, on two boards: what the cells feel follows from
/// COP = c - c'' z / (z'' + g), with the load shared by where the COP is between the boards.
struct MadeBody {
  std::function<Eigen::Vector3d(double)> com_m = [](double) {
    return Eigen::Vector3d(0, 0, kMadeHeightM);
  };
  double noise_n = 0;
  noise::Random random{5};

  Eigen::Vector3d Acceleration(double t) const {
    constexpr double kH = 1e-3;
    return (com_m(t + kH) - 2 * com_m(t) + com_m(t - kH)) / (kH * kH);
  }

  ContactLoads At(double t) {
    const Eigen::Vector3d c = com_m(t), a = Acceleration(t);
    const double load = kMadeMassKg * (a.z() + kStandardGravityMps2);
    const Eigen::Vector2d cop = c.head<2>() - a.head<2>() * c.z() / (a.z() + kStandardGravityMps2);
    const double left = 0.5 + 0.5 * cop.y() / kBoardYM;
    ContactLoads loads;
    loads.time_s = t;
    for (std::size_t f = 0; f < kFeet; ++f) {
      const double y = f == 0 ? kBoardYM : -kBoardYM;
      const double share = f == 0 ? left : 1 - left;
      FootLoads& foot = loads.feet[f];
      foot.valid = true;
      foot.count = 4;
      for (std::size_t i = 0; i < 4; ++i) {
        const double front = i < 2 ? 1 : -1, side = i % 2 == 0 ? 1 : -1;
        foot.cells[i].p_WS_m = {front * kHalfLengthM, y + side * kHalfWidthM, 0};
        foot.cells[i].load_n =
            load * share * 0.25 * (1 + front * cop.x() / kHalfLengthM) + noise_n * random.Normal();
      }
    }
    return loads;
  }

  /// The T-pose it stands in before anything happens (the motion must rest at t < 0).
  TPose Calibrate() {
    TPoseCalibration calibration;
    for (int i = -600; i < 0; ++i)
      if (calibration.Advance(At(i * kMadeStepS), kMadeStepS)) break;
    return calibration.result();
  }
};

/// From loads to momentum, by way of the contacts.
struct Estimators {
  Estimators(const BestConfig& config, const Subject& subject, const TPose& pose, double step_s)
      : contacts(subject, pose, step_s), momentum(config, subject, pose, step_s) {}

  const Estimate& Advance(const ContactLoads& loads,
                          const std::optional<PostureCom>& posture = std::nullopt) {
    return momentum.Advance(contacts.Advance(loads), posture);
  }

  ContactEstimator contacts;
  BestEstimator momentum;
};

inline VerticalInput Groups(const ContactLoads& loads, double least_cop_load_n) {
  return ToVerticalInput(loads, PressureOf(loads, least_cop_load_n));
}

/// 0 before t = 0, then from rest into a steady value of 1 within a second.
inline double Ramp(double t) {
  if (t <= 0) return 0;
  return t >= 1 ? 1 : t * t * t * (10 - 15 * t + 6 * t * t);
}

// Squats of 30 cm every four seconds, upright between them.
inline MadeBody Squatter() {
  MadeBody body;
  body.noise_n = 0.5;
  body.com_m = [](double t) {
    const double phase = t - 4 * std::floor(t / 4);
    const double down = t > 0 ? Ramp(phase - 1) - Ramp(phase - 2.5) : 0;
    return Eigen::Vector3d(0, 0, kMadeHeightM - 0.3 * down);
  };
  return body;
}

}  // namespace footing::momentum
