#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/guide/camera_step.h"
#include "common/guide/recent.h"

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

inline constexpr double kWeighForS = 3;
inline constexpr double kLeastMassKg = 10;
inline constexpr double kMostMassKg = 200;

/// Result of weighing a person on the boards.
struct Weight {
  bool done = false;    ///< Quiet enough and plausible; else wait, or say what `note` says.
  bool passed = false;  ///< And within 3 % or 2 kg of the mass that was given, if any.
  double mass_kg = 0;
  double sd_kg = 0;  ///< The residual.
  std::string note;
};

/// The person on all boards together, standing still for kWeighForS. Quiet is a standard deviation
/// under 1.5 % of the weight: standing people sway by 0.4 % (0.18 kg of 46 kg on a real board).
Weight Weigh(const std::vector<Load>& boards, std::optional<double> given_kg);

}  // namespace footing::guide
