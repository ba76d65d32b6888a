#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/guide/layout.h"
#include "common/guide/step.h"

/// The items about boards. A rig without boards finishes each at once, without a result.
namespace footing::guide {

/// Sets the layout and proves it: stand left, stand right, both, lean forward.
class LayoutStep {
 public:
  Progress Advance(const Situation& now, const SetUpOptions& options);

 private:
  enum class Phase { kBegin, kSetting, kLeft, kRight, kUpright, kForward, kEnd };
  void Begin(const Situation& now, const SetUpOptions& options);
  Progress Set();
  Progress One(const Situation& now, const SetUpOptions& options);
  Progress Both(const Situation& now, const SetUpOptions& options);
  Stance Stand(const Situation& now, const SetUpOptions& options, double window_s) const;

  Phase phase_ = Phase::kBegin;
  bool two_ = false;
  stream::BoardLayout layout_;
  LayoutObserved observed_;
  std::vector<stream::SetupItem> results_;
};

/// Takes each empty board's zero.
class TareStep {
 public:
  Progress Advance(const Situation& now, const SetUpOptions& options);

 private:
  bool asked_ = false;
  std::size_t waiting_ = 0;
  std::vector<stream::SetupItem> results_;
};

/// Weighs the person who stands on all boards.
class WeighStep {
 public:
  Progress Advance(const Situation& now, const SetUpOptions& options);
};

}  // namespace footing::guide
