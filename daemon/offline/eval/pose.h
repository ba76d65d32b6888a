#pragma once

#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "daemon/offline/eval/report.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/simulation/reconstruction/models.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::eval {

/// `pose`: the whole body from simulated boards and hands under a motion.
void AddPoseCommand(CLI::App& app, Shared& shared);

/// Runs the reconstruction over somebody who walks in insoles, from the T-pose's end on, and
/// evaluates it root-relative; how far the root is off in W is beside it.
Result<nlohmann::ordered_json> ScoreInsoles(const pose_run::InsoleRun& run,
                                            const reconstruction::Models& models,
                                            const reconstruction::Options& options);

/// Scores of baselines on the same frames, from `start` on: a T-pose that stays, the
/// mean pose of the basis, both where the T-pose was, and the same solver and prior from hands and
/// feet alone.
Result<nlohmann::ordered_json> ScoreBaselines(const pose_run::PoseRun& run,
                                              const reconstruction::Models& models,
                                              const reconstruction::Options& options,
                                              std::size_t start);

/// Tests two claims of the paper's section 4.1 on a motion.
///
/// `constant_velocity`: "less than 0.5 % of the motion maintains a nonzero constant COM velocity
/// more than 0.05 second". Here: the share of the frames in runs of more than 0.05 s in which the
/// velocity's size is over 0.05 m/s and the acceleration's size is under a limit; the paper names
/// neither, so the limits are a list. Of the vertical axis, which the rule is used on, and of all
/// three. Velocity and acceleration are central differences of the true COM, low-passed at 6 Hz.
///
/// `outlier`: what one frame of 50 N too much leaves in the height of equation (2) with the decay
/// and without it, 1, 5 and 10 s later; on a body that stands still, and in the motion (as the
/// difference from the same run without the outlier, whose own error is beside it).
nlohmann::ordered_json CheckClaims(const pose_run::PoseRun& simulated);

/// Share of the frames (a column each) in runs longer than `least_run_s` in which |velocity| >
/// `least_speed` and |acceleration| < `most_acceleration`; sizes over all rows.
double ConstantVelocityShare(const Eigen::MatrixXd& velocity, const Eigen::MatrixXd& acceleration,
                             double rate_hz, double least_speed, double most_acceleration,
                             double least_run_s);

}  // namespace footing::eval
