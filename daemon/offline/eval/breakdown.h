#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <vector>

#include "daemon/offline/analysis/pose_metrics.h"
#include "daemon/offline/pose_run/lift_off.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::eval {

/// Errors by what the person does, and of legs in the air.
class PoseBreakdown {
 public:
  /// `run` must outlive it.
  explicit PoseBreakdown(const pose_run::PoseRun& run);

  /// The output for frame `i`; `score` has just taken it.
  void Add(const reconstruction::Output& estimate, const PoseScore& score, std::size_t i);

  /// Fields lift_off, aloft, kick and, where the activities are given, by_activity.
  nlohmann::ordered_json Json() const;

 private:
  struct Activity {
    Spread mpjpe_cm, com_vertical_cm;
  };

  const pose_run::PoseRun& run_;
  std::array<std::array<int, pose_run::kLegJoints>, momentum::kFeet> legs_{};
  pose_run::LiftOffs lift_offs_;
  std::vector<Activity> activities_;
};

}  // namespace footing::eval
