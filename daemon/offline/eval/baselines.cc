#include "daemon/offline/eval/baselines.h"

#include <cmath>

#include "daemon/offline/analysis/pose_metrics.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;

double Still(const pose_run::PoseRun& run, const Eigen::VectorXd& q, std::size_t start) {
  PoseScore score(run.body);
  for (std::size_t i = start; i < run.frames.size(); ++i) {
    score.Add(q, run.frames[i].q);
  }
  return score.mpjpe_cm();
}

/// All frames of a reconstruction with these options.
Result<ordered_json> Rebuilt(const pose_run::PoseRun& run, const reconstruction::Models& models,
                             const reconstruction::Options& options, std::size_t start) {
  auto made = reconstruction::Reconstruction::Create(run.body, models, options);
  if (!made) return made.error();
  PoseScore score(run.body);
  const auto lag = static_cast<std::size_t>(std::lround(options.lag_s * options.rate_hz));
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    const auto& output = made->Advance(run.frames[i].inputs);
    if (i >= start) score.Add(output.q, run.frames[i - lag].q);
  }
  return score.Json();
}

}  // namespace

Result<ordered_json> ScoreBaselines(const pose_run::PoseRun& run,
                                    const reconstruction::Models& models,
                                    const reconstruction::Options& options, std::size_t start) {
  ordered_json json;
  const Eigen::VectorXd& t_pose = run.frames.front().q;
  json["t_pose"]["mpjpe_cm"] = Still(run, t_pose, start);
  Eigen::VectorXd mean = models.basis.mean;
  if (models.root_height_m > 0) {
    const body::Body& body = run.body;
    mean.head<3>() *= body::TPose(body.skeleton, body.landmarks)(2) / models.root_height_m;
  }
  for (const auto& foot : run.frames.front().feet) {
    mean.head<2>() += 0.25 * (foot.ankle_m + foot.toe_m).head<2>();
  }
  json["mean_pose"]["mpjpe_cm"] = Still(run, mean, start);

  reconstruction::Options without = options;
  without.use_momentum = without.use_angular_momentum = false;
  without.use_posture = false;
  const auto bare = Rebuilt(run, models, without, start);
  if (!bare) return bare.error();
  json["hands_feet_ik"] = *bare;
  if (!models.posture.empty()) {
    without.use_posture = true;
    const auto learned = Rebuilt(run, models, without, start);
    if (!learned) return learned.error();
    json["hands_feet_learned"] = *learned;
  }
  return json;
}

}  // namespace footing::eval
