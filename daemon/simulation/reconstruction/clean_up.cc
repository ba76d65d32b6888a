#include "daemon/simulation/reconstruction/clean_up.h"

#include "common/body/points.h"
#include "daemon/simulation/reconstruction/pose_targets.h"

namespace footing::reconstruction {
namespace {

constexpr int kLegIterations = 2;

}  // namespace

void ShowFeet(const SubjectModel& model, const pose::PoseTargets& targets,
              pose::PoseTargets& shown) {
  Clear(shown);
  for (const FootGeometry& foot : model.feet) {
    const auto points = PointsOf(foot, targets);
    if (!points) continue;
    for (const pose::PointTarget& point : *points) shown.Add(point);
  }
}

void FootHold::ShowFeet(const SubjectModel& model, const pose::PoseTargets& targets,
                        const momentum::Estimate& momentum, const Output& before, double step_s,
                        pose::PoseTargets& shown) {
  Clear(shown);
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    auto points = PointsOf(model.feet[f], targets);
    if (!points) continue;
    FootLock::Places estimated, shown_before;
    for (std::size_t i = 0; i < points->size(); ++i) {
      const pose::PointTarget& point = (*points)[i];
      const auto joint = static_cast<std::size_t>(point.joint);
      estimated[i] = point.p_W_m;
      shown_before[i] =
          body::Place({point.joint, point.p_J_m}, before.R_WJ[joint], before.p_WJ_m[joint]);
    }
    const FootLock::Places places =
        locks_[f].Advance(momentum.feet[f].contact, estimated, shown_before, step_s);
    for (std::size_t i = 0; i < points->size(); ++i) {
      (*points)[i].p_W_m = places[i];
      shown.Add((*points)[i]);
    }
  }
}

void LegCleanUp::Solve(const pose::PoseTargets& shown, std::size_t foot, SolvedPose& pose) {
  legs_[foot].Solve(shown, kLegIterations, pose.q, pose.at);
}

void LegCleanUp::SolveBoth(const pose::PoseTargets& shown, SolvedPose& pose) {
  for (std::size_t f = 0; f < legs_.size(); ++f) Solve(shown, f, pose);
}

}  // namespace footing::reconstruction
