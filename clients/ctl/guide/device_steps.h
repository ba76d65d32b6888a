#pragma once

#include <set>
#include <string>
#include <vector>

#include "clients/ctl/guide/pick.h"
#include "clients/ctl/guide/step.h"

/// The items about devices. Each is a plain value; Advance() is called some twenty times a second.
namespace footing::guide {

/// A Bluetooth adapter, or devices that need none.
class AdapterStep {
 public:
  Progress Advance(const Situation& now, const Wishes& wishes);
};

/// Devices are attached and live, and no more come.
class PairingStep {
 public:
  Progress Advance(const Situation& now, const Wishes& wishes);

 private:
  std::size_t seen_ = 0;
  std::int64_t since_ns_ = 0;
};

/// Which device is which: "Step on the left board now.", "Shake the left wrist now."
class RolesStep {
 public:
  Progress Advance(const Situation& now, const Wishes& wishes);

 private:
  enum class Phase { kBegin, kAsk, kAssigning, kRest, kEnd };
  void Begin(const Situation& now, const Wishes& wishes);
  void BeginWith(const std::vector<stream::DeviceStatus>& devices,
                 const std::vector<stream::DeviceRole>& roles);
  Progress Ask(const Situation& now, const Wishes& wishes);
  void AddTheRest(const Situation& now, const Wishes& wishes);
  Progress Assign(const stream::DeviceStatus& device, const Pick& pick);
  bool Resting(const Situation& now, const Wishes& wishes) const;

  Phase phase_ = Phase::kBegin;
  std::vector<stream::DeviceRole> wanted_;  ///< Still to be asked for, in order.
  std::set<std::string> named_;             ///< Serials that have been picked.
  std::set<stream::DeviceRole> alone_;      ///< Of a device that there is nothing to tell from.
  std::int64_t rest_since_ns_ = 0;
  std::vector<stream::SetupItem> results_;
};

/// Rates, calibrations, batteries, slips: all that the devices tell of themselves.
class ChecksStep {
 public:
  Progress Advance(const Situation& now, const Wishes& wishes);

 private:
  std::int64_t since_ns_ = 0;
};

/// What a device's own status says against it; empty when nothing does. Bars: boards 30 reports a
/// second (a poor link brings 58), controllers 60 (100 is usual).
std::string WrongWith(const stream::DeviceStatus& device);

/// "the left board", "the left wrist", "the right shin", ...
std::string Spoken(stream::DeviceRole role);

}  // namespace footing::guide
