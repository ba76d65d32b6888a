#include "daemon/offline/eval/ablations.h"

#include <array>
#include <string>

#include "daemon/offline/eval/pose_trial.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;
using reconstruction::Mode;

constexpr std::array kReported{"mpjpe_cm",
                               "mpjpe_p95_cm",
                               "mpjpe_root_relative_cm",
                               "mpjpe_legs_cm",
                               "mpjpe_torso_cm",
                               "mpjpe_arms_cm",
                               "joint_angle_error_deg",
                               "com_vertical_rms_cm",
                               "com_horizontal_rms_cm",
                               "pose_com_vertical_rms_cm",
                               "pose_com_horizontal_rms_cm",
                               "foot_position_rms_cm",
                               "foot_skate_cm_per_s",
                               "solve_us_p50",
                               "finite"};

struct Ablation {
  const char* without;
  bool reconstruction::Options::*term;  ///< Null: nothing is left out of the solver.
};

constexpr std::array kAblations{
    Ablation{"nothing", nullptr},
    Ablation{"angular_momentum", &reconstruction::Options::use_angular_momentum},
    Ablation{"momentum", &reconstruction::Options::use_momentum},
    Ablation{"cleanup", &reconstruction::Options::clean_up},
    Ablation{"basis", &reconstruction::Options::use_basis},
    Ablation{"posture", &reconstruction::Options::use_posture}};

Result<ordered_json> Row(const pose_run::PoseRun& run, const reconstruction::Models& models,
                         const reconstruction::Options& options, const std::string& without) {
  const auto trial = RunPoseTrial(run, models, options, {});
  if (!trial) return trial.error();
  ordered_json row = {{"mode", options.mode == Mode::kBest ? "best" : "paper"},
                      {"without", without}};
  for (const char* name : kReported) {
    if (trial->contains(name)) row[name] = (*trial)[name];
  }
  return row;
}

}  // namespace

Result<ordered_json> ScoreAblations(const pose_run::PoseRun& run,
                                    const reconstruction::Models& models,
                                    const reconstruction::Options& options) {
  ordered_json rows = ordered_json::array();
  for (const Mode mode : {Mode::kBest, Mode::kPaper}) {
    reconstruction::Options of_mode = options;
    of_mode.mode = mode;
    if (mode == Mode::kPaper) of_mode.lag_s = 0;
    for (const Ablation& ablation : kAblations) {
      // The paper's estimators know of no posture.
      if (mode == Mode::kPaper && ablation.term == &reconstruction::Options::use_posture) continue;
      reconstruction::Options without = of_mode;
      if (ablation.term != nullptr) without.*ablation.term = false;
      auto row = Row(run, models, without, ablation.without);
      if (!row) return row.error();
      rows.push_back(std::move(*row));
    }
    if (mode == Mode::kPaper && models.horizontal) {
      reconstruction::Models cop = models;
      cop.horizontal.reset();
      auto row = Row(run, cop, of_mode, "horizontal_network");
      if (!row) return row.error();
      rows.push_back(std::move(*row));
    }
  }
  return rows;
}

}  // namespace footing::eval
