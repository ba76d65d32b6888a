#pragma once

#include <vector>

#include "common/guide/mounting.h"
#include "common/guide/step.h"

namespace footing::guide {

/// Finds the rotation of every mounted device by two seconds still and three steps. A rig without
/// one finishes at once, without a result.
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
