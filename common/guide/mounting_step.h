#pragma once

#include <vector>

#include "common/guide/mounting.h"
#include "common/guide/step.h"

namespace footing::guide {

/// Finds the rotation of every mounted device by two seconds still and three steps. A rig without
/// one finishes at once, without a result. A remote of a hand is taken as held, which needs no
/// mounting, unless its role was named as worn, it was mounted before, or all are asked for.
class MountingStep {
 public:
  Progress Advance(const Situation& now, const SetUpOptions& options);

 private:
  Progress Solve(const Situation& now, const SetUpOptions& options);

  StillThenSteps stretches_;
  bool asked_ = false;
  std::size_t waiting_ = 0;
  std::vector<stream::SetupItem> results_;
};

}  // namespace footing::guide
