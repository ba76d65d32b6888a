#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>

#include "daemon/offline/analysis/contact_score.h"
#include "daemon/offline/analysis/pose_metrics.h"
#include "daemon/offline/analysis/stance_frames.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/simulation/reconstruction/feet.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::eval {

/// Feet against the truth: contact, place, and how they slide while they stand.
class FootScore {
 public:
  /// `run` must outlive it. Outputs come `lag` frames late.
  FootScore(const pose_run::PoseRun& run, std::size_t lag);

  /// The output that came with frame `i`; `score` has just taken it.
  void Add(const reconstruction::Output& output, const PoseScore& score, std::size_t i);
  void WriteTo(nlohmann::ordered_json& json) const;

 private:
  using SolePoints = std::array<Eigen::Vector3d, 2>;  ///< Heel and ball.

  /// What is known of a foot from the frame before.
  struct Foot {
    reconstruction::FootGeometry geometry;
    int ankle = 0, toe = 0;  ///< Joints.
    StanceFrames stance;
    bool contact = false;  ///< Estimated.
    Eigen::Vector3d toe_m = Eigen::Vector3d::Zero(), true_toe_m = Eigen::Vector3d::Zero();
    SolePoints sole_m{}, true_sole_m{};
  };

  void AddPlace(const PoseScore& score, const Foot& foot);
  void AddBallSpeed(const PoseScore& score, bool contact, Foot& foot);
  void AddSkate(const momentum::FootLoads& loads, const PoseScore& score, bool settled, Foot& foot);

  const pose_run::PoseRun& run_;
  const std::size_t lag_;
  const double step_s_;
  std::size_t first_on_feet_ = 0;  ///< Before, the way from the T-pose slides them.
  std::array<Foot, momentum::kFeet> feet_;
  ContactScore contacts_;
  Spread place_, skate_, true_skate_, ball_speed_, true_ball_speed_;
};

}  // namespace footing::eval
