#pragma once

#include <vector>

#include "clients/ctl/guide/mounting.h"
#include "clients/ctl/guide/step.h"

namespace footing::guide {

/// Finds the rotation of every worn device by two seconds still and three steps. A rig without one
/// finishes at once, without a result.
class MountingStep {
 public:
  Progress Advance(const Situation& now, const Wishes& wishes);

 private:
  Progress Solve(const Situation& now, const Wishes& wishes);

  StillThenSteps stretches_;
  bool asked_ = false;
  std::size_t waiting_ = 0;
  std::vector<stream::SetupItem> results_;
};

}  // namespace footing::guide
