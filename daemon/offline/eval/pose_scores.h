#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "common/body/body.h"
#include "daemon/offline/analysis/angle_score.h"
#include "daemon/offline/analysis/pose_metrics.h"
#include "daemon/offline/eval/pose_scene.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/simulation/reconstruction/reconstruction.h"
#include "daemon/simulation/reconstruction/subject_model.h"

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

  /// State of a foot from the frame before.
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
  Spread loads_vertical_;                   ///< Errors of the estimate from the loads alone.
  std::array<Spread, 3> posture_;           ///< Errors of the one from hands and feet alone.
  Spread pose_vertical_, pose_horizontal_;  ///< Errors of the pose's own COM.
  double nees_ = 0;                         ///< Vertical, summed.
  std::size_t frames_ = 0;
  std::array<Spread, 3> angular_;
};

/// The command line of footing-eval pose.
struct PoseFlags {
  PoseSceneOptions scene;
  reconstruction::Options options;
  std::vector<std::string> models, ablate, oracle, constants;
  std::string hands = "move", mode = "best", boards = "simulated", head = "none";
  std::vector<std::string> segments;
  double lag_ms = 0, loop_minutes = 0, yaw_error_deg = 0, height_m = 0;
  std::string figures;
  bool baselines = true, ablations = false, claims = false, same_person = false;
};

inline bool Has(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

/// Adds the options of a pose subcommand.
void AddPoseFlags(CLI::App& command, PoseFlags& flags);
/// Translates the strings into the options; an error names the flag.
Result<void> Translate(PoseFlags& flags);

/// Sets constants of the modes by "name=value", to choose them on clips for validation. An
/// error lists the names.
Result<void> SetConstants(const std::vector<std::string>& assignments,
                          reconstruction::Options& options);

}  // namespace footing::eval
