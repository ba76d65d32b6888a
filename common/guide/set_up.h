#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "common/guide/board_steps.h"
#include "common/guide/camera_step.h"
#include "common/guide/device_steps.h"
#include "common/guide/recent.h"

namespace footing::guide {

/// It is fastened to a limb, so its directions have to be found.
bool NeedsMounting(stream::DeviceRole role);
/// Its directions can be found: those of what needs it, and of a remote on a wrist. One that is
/// held in the hand, buttons up, lies as it should.
bool CanBeMounted(stream::DeviceRole role);
/// How a device is mounted, drawn for a terminal: shin outside, head band, wrist. Empty for boards.
std::string Picture(stream::DeviceRole role);
/// The same in a sentence.
std::string Wearing(stream::DeviceRole role);

inline constexpr double kStillForS = 2;

/// Stretches of "two seconds still, then three steps" in the samples of the mounted devices.
/// The steps begin half a second before a movement shows, so that its very first way is among them.
/// A plain value that is asked again and again.
class StillThenSteps {
 public:
  enum class Phase { kStill, kSteps, kDone };

  /// `moving_mps2` is the largest shake of all mounted devices during the last half second; not
  /// known (no samples) counts as moving.
  void Advance(std::int64_t now_ns, double moving_mps2);

  Phase phase() const { return phase_; }
  /// Stillness so far, s; at most kStillForS counts.
  double still_s(std::int64_t now_ns) const;
  std::int64_t still_from_ns() const { return still_from_ns_; }
  std::int64_t still_to_ns() const { return still_to_ns_; }
  std::int64_t steps_from_ns() const { return still_to_ns_; }
  std::int64_t steps_to_ns() const { return steps_to_ns_; }

 private:
  Phase phase_ = Phase::kStill;
  std::int64_t still_from_ns_ = 0;  // 0: not still.
  std::int64_t still_to_ns_ = 0;
  std::int64_t moved_first_ns_ = 0;
  std::int64_t moved_last_ns_ = 0;
  std::int64_t steps_to_ns_ = 0;
};

/// A solved mounting is good up to this residual.
inline constexpr double kMountingBarDeg = 15;

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

/// The guided set-up of a rig: its items one after the other, each tried again when it fails, and
/// given up when it gets nowhere. A plain value.
class SetUp {
 public:
  SetUp(SetUpOptions options, std::vector<Item> items);

  /// Call some twenty times a second with what is known. `results` of the answer are final and to
  /// be recorded; finished means that all items are through.
  Progress Advance(const Situation& now);

  /// The item that is under way.
  Item item() const { return items_[std::min(index_, items_.size() - 1)]; }
  /// All results of this run, in order.
  const std::vector<stream::SetupItem>& results() const { return results_; }

 private:
  using Step = std::variant<AdapterStep, PairingStep, RolesStep, LayoutStep, TareStep, MountingStep,
                            WeighStep, CameraStep, ChecksStep>;
  static Step StepOf(Item item);
  void Begin();

  SetUpOptions options_;
  std::vector<Item> items_;
  std::size_t index_ = 0;
  Step step_;
  int tried_ = 0;
  std::int64_t progress_ns_ = 0;  ///< The last time that something new was asked; 0: not begun.
  std::string asked_;
  std::string refused_;  ///< Why the last try failed.
  std::vector<stream::SetupItem> results_;
};

/// The rig's items as they stand after this run: what was recorded before, with new results in
/// place of old ones, and stale where the devices of now say so.
std::vector<stream::SetupItem> Merged(const std::vector<stream::SetupItem>& recorded,
                                      const std::vector<stream::SetupItem>& results,
                                      const std::vector<stream::DeviceStatus>& rig_devices);

/// Everything that this rig's devices need has passed and is not stale. `missing` names the rest.
bool Ready(const std::vector<stream::SetupItem>& items,
           const std::vector<stream::DeviceStatus>& rig_devices, std::vector<std::string>* missing);

}  // namespace footing::guide
