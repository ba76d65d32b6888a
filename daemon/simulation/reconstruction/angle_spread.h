#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "common/body/angle_deviation.h"
#include "common/body/landmarks.h"
#include "daemon/simulation/momentum/estimate.h"
#include "daemon/simulation/pose/gauss_newton.h"
#include "daemon/simulation/reconstruction/subject_model.h"

namespace footing::reconstruction {

/// Standard deviations of the angles of pelvis, trunk and legs in one frame, rad, by
/// body::kStatedAngles.
using AngleSd = std::array<double, body::kStatedAngles.size()>;

/// The largest deviation that is stated: that of any direction.
inline constexpr double kUnknownAngleRad = 1.81;
inline constexpr double kDeepBendRad = 1.2;  ///< Bend of the knees from which on it counts fully.

constexpr AngleSd UnknownAngles() {
  AngleSd sd_rad{};
  sd_rad.fill(kUnknownAngleRad);
  return sd_rad;
}

/// Deviations of the angles by the terms that the solver linearises: of the turn of a segment
/// against the one above it, about the axes of Grood & Suntay 1983 (joint_angles), since the
/// T-pose. What is known of people is part of them, so an angle that no sensor shows has the
/// deviation that people have. A few a frame. A value; `model` must outlive it.
class AngleSpread {
 public:
  explicit AngleSpread(const SubjectModel& model);

  void Start() { sd_rad_ = UnknownAngles(); }
  /// At the solver's last solution.
  void Advance(const BestConstants& best, pose::GaussNewton& solver);
  /// The deviations, times `doubt`; those of a leg in the air grow as its joints' do.
  AngleSd Report(double doubt, const momentum::Estimate& then, const BestConstants& best) const;

 private:
  double KneeBendRad(const body::Kinematics& at) const;
  void Measure(std::size_t turn, pose::GaussNewton& solver);

  const SubjectModel* model_;
  std::size_t next_ = 0;
  AngleSd sd_rad_ = UnknownAngles();
};

}  // namespace footing::reconstruction
