#pragma once

#include <set>
#include <string>
#include <vector>

#include "common/guide/pick.h"
#include "common/guide/step.h"

/// The items about devices. Each is a plain value; Advance() is called some twenty times a second.
namespace footing::guide {

/// A Bluetooth adapter, or devices that need none.
class AdapterStep {
 public:
  Progress Advance(const Situation& now, const SetUpOptions& options);
};

/// Devices are attached and live, and no more come.
class PairingStep {
 public:
  Progress Advance(const Situation& now, const SetUpOptions& options);

 private:
  std::size_t seen_ = 0;
  std::int64_t since_ns_ = 0;
};

/// Which device is which: "Step on the left board now.", "Shake the left wrist now."
class RolesStep {
 public:
  Progress Advance(const Situation& now, const SetUpOptions& options);

 private:
  enum class Phase { kBegin, kAsk, kAssigning, kRest, kEnd };
  void Begin(const Situation& now, const SetUpOptions& options);
  void BeginWith(const std::vector<stream::DeviceStatus>& devices,
                 const std::vector<stream::DeviceRole>& roles);
  Progress Ask(const Situation& now, const SetUpOptions& options);
  void AddTheRest(const Situation& now, const SetUpOptions& options);
  Progress Assign(const stream::DeviceStatus& device, const Pick& pick);
  bool Resting(const Situation& now, const SetUpOptions& options) const;

  Phase phase_ = Phase::kBegin;
  std::vector<stream::DeviceRole> wanted_;  ///< Still to be asked for, in order.
  std::set<std::string> named_;             ///< Serials that have been picked.
  std::set<stream::DeviceRole> alone_;      ///< Of a device that is the only one of its kind.
  std::int64_t rest_since_ns_ = 0;
  std::vector<stream::SetupItem> results_;
};

/// Rates, calibrations, batteries, slips: what the devices report of themselves.
class ChecksStep {
 public:
  Progress Advance(const Situation& now, const SetUpOptions& options);

 private:
  std::int64_t since_ns_ = 0;
};

/// The fault that a device's own status shows; empty when there is none. Bars: boards 30 reports a
/// second (a poor link brings 58), controllers 60 (100 is usual).
std::string FaultOf(const stream::DeviceStatus& device);

/// "the left board", "the left wrist", "the right shin", ...
std::string RoleText(stream::DeviceRole role);

}  // namespace footing::guide
