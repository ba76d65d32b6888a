#pragma once

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "common/guide/board_steps.h"
#include "common/guide/camera_step.h"
#include "common/guide/device_steps.h"
#include "common/guide/mounting_step.h"
#include "common/guide/step.h"

namespace footing::guide {

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
