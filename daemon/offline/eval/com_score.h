#pragma once

#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>

#include "common/body/body.h"
#include "daemon/offline/analysis/pose_metrics.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::eval {

/// Slope of |error| over time, by least squares.
class Drift {
 public:
  void Add(double t_s, double error) {
    ++n_;
    t_ += t_s;
    e_ += error;
    tt_ += t_s * t_s;
    te_ += t_s * error;
  }
  double PerMinute() const {
    const double spread = n_ * tt_ - t_ * t_;
    return spread > 0 ? 60 * (n_ * te_ - t_ * e_) / spread : 0;
  }

 private:
  double n_ = 0, t_ = 0, e_ = 0, tt_ = 0, te_ = 0;
};

/// COM and angular momentum against the truth, cm and kg m²/s.
class ComScore {
 public:
  /// The output for the frame `truth`; `score` has just taken it.
  void Add(const body::Body& body, const reconstruction::Output& output, const PoseScore& score,
           const pose_run::Frame& truth);
  void WriteTo(nlohmann::ordered_json& json) const;

 private:
  Spread vertical_, horizontal_, forward_, lateral_;
  Drift vertical_drift_, horizontal_drift_;
  Spread loads_vertical_;                   ///< Of the estimate from the loads alone.
  std::array<Spread, 3> posture_;           ///< Of hands and feet alone.
  Spread pose_vertical_, pose_horizontal_;  ///< Of the pose's own COM.
  double nees_ = 0;                         ///< Vertical, summed.
  std::size_t frames_ = 0;
  std::array<Spread, 3> angular_;
};

}  // namespace footing::eval
