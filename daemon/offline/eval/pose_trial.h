#pragma once

#include <array>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "daemon/offline/analysis/pose_metrics.h"
#include "daemon/offline/pose_run/lift_off.h"
#include "daemon/offline/pose_run/plates.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::eval {

/// True values given to the reconstruction instead of its own estimates.
struct Oracle {
  bool com = false, momentum = false, feet = false;
};

/// Runs one reconstruction over a run and evaluates all its outputs, from
/// run.judged_from on.
Result<nlohmann::ordered_json> RunPoseTrial(const pose_run::PoseRun& run,
                                            const reconstruction::Models& models,
                                            const reconstruction::Options& options,
                                            const Oracle& oracle);

/// The paper's section 7.4 for every term, in both modes: all terms, without each of them, and in
/// paper mode without the networks of 4.2. Options are those of all runs but their mode and terms;
/// lag is the best mode's alone. A row each: {mode, without, mpjpe_cm, ...}.
Result<nlohmann::ordered_json> ScoreAblations(const pose_run::PoseRun& run,
                                              const reconstruction::Models& models,
                                              const reconstruction::Options& options);

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

/// Scores against the plates: the centre of mass along each axis, and the same reconstruction on
/// simulated forces, over the same frames. Field `plates` of `pose --boards forces`.
Result<nlohmann::ordered_json> ScorePlates(const pose_run::PlateRun& plates,
                                           const reconstruction::Models& models,
                                           const reconstruction::Options& options,
                                           const Oracle& oracle);

}  // namespace footing::eval
