#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <vector>

#include "daemon/offline/eval/pose_metrics.h"
#include "daemon/offline/rehearsal/lift_off.h"
#include "daemon/offline/rehearsal/rehearsal.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::eval {

/// Errors by what the person does, and of legs in the air.
class PoseBreakdown {
 public:
  /// `rehearsal` must outlive it.
  explicit PoseBreakdown(const rehearsal::Rehearsal& rehearsal);

  /// What was told of frame `i`; `score` has just taken it.
  void Add(const reconstruction::Output& told, const PoseScore& score, std::size_t i);

  /// Fields lift_off, aloft, kick and, where somebody has told the activities, by_activity.
  nlohmann::ordered_json Json() const;

 private:
  struct Activity {
    Spread mpjpe_cm, com_vertical_cm;
  };

  const rehearsal::Rehearsal& rehearsal_;
  std::array<std::array<int, rehearsal::kLegJoints>, momentum::kFeet> legs_{};
  rehearsal::LiftOffs lift_offs_;
  std::vector<Activity> activities_;
};

}  // namespace footing::eval
