#pragma once

#include <Eigen/Core>
#include <array>

#include "common/body/kinematics.h"
#include "daemon/simulation/momentum/estimate.h"
#include "daemon/simulation/pose/leg_ik.h"
#include "daemon/simulation/pose/targets.h"
#include "daemon/simulation/reconstruction/foot_lock.h"
#include "daemon/simulation/reconstruction/output.h"
#include "daemon/simulation/reconstruction/subject_model.h"

/// The fifth step: the solver's pose has the feet where they are most likely; the legs, and these
/// alone, bring them to where they are shown.
namespace footing::reconstruction {

/// A pose and where it has the joints.
struct SolvedPose {
  Eigen::VectorXd q;
  body::Kinematics at;
};

/// Shows the feet where the solver's targets have them.
void ShowFeet(const SubjectModel& model, const pose::PoseTargets& targets,
              pose::PoseTargets& shown);

/// Shows feet on the ground where they stand, so that they do not slide while their estimate
/// wanders. A value.
class FootHold {
 public:
  void Start() { locks_.fill(FootLock()); }
  /// One frame: `targets` in W, `before` the frame before.
  void ShowFeet(const SubjectModel& model, const pose::PoseTargets& targets,
                const momentum::Estimate& momentum, const Output& before, double step_s,
                pose::PoseTargets& shown);

 private:
  std::array<FootLock, momentum::kFeet> locks_;
};

/// Both legs.
class LegCleanUp {
 public:
  /// `model` must outlive it.
  explicit LegCleanUp(const SubjectModel& model) : legs_{LegOf(model, 0), LegOf(model, 1)} {}

  void Solve(const pose::PoseTargets& shown, std::size_t foot, SolvedPose& pose);
  void SolveBoth(const pose::PoseTargets& shown, SolvedPose& pose);

 private:
  std::array<pose::LegIk, momentum::kFeet> legs_;
};

}  // namespace footing::reconstruction
