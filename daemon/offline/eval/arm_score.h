#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

#include "daemon/offline/analysis/pose_metrics.h"
#include "daemon/simulation/pose/arm_geometry.h"
#include "daemon/simulation/pose/arm_model.h"

namespace footing::eval {

/// One way to estimate an arm, against the truth.
class ArmScore {
 public:
  void Add(const arms::ArmGeometry& geometry, const arms::ArmDirections& estimate,
           const arms::ArmDirections& truth, const Eigen::Vector3d& hand_m);
  /// The fields of `footing-eval arm` that every way has.
  nlohmann::ordered_json Json() const;

 private:
  Spread shoulder_, elbow_, hand_;
  std::vector<double> cm_;  ///< Of hand_, in the order of time.
};

/// How far the estimated rotation of a device since the T-pose is off, in all and of its up alone.
class TurnScore {
 public:
  void Add(const Eigen::Matrix3d& estimate, const Eigen::Matrix3d& truth);
  double mean_deg() const { return all_.mean(); }
  double inclination_deg() const { return inclination_.mean(); }

 private:
  Spread all_, inclination_;
};

/// Squared errors over the variances that go with them, per number; 1 where the deviations are
/// right.
class NeesScore {
 public:
  void Add(const arms::ArmEstimate& estimate, const arms::ArmDirections& truth);
  /// Of all, and of parts of equal duration.
  double mean() const;
  std::vector<double> Parts(std::size_t count) const;

 private:
  std::vector<double> nees_;
};

}  // namespace footing::eval
