#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "common/board/geometry.h"
#include "common/guide/camera_step.h"
#include "common/guide/recent.h"

namespace footing::guide {

/// Which of several devices the person means. Never a guess: when two could be meant it says so.
struct Pick {
  enum class Kind { kNone, kOne, kAmbiguous };
  Kind kind = Kind::kNone;
  std::uint32_t device = 0;  ///< The device that is meant, with kOne.
  double lead = 0;           ///< How clearly: its signal over the next one's, at most 99.
  std::string note;          ///< Observation, for a person.
};

/// Load on one board during a stretch of time.
struct BoardLoad {
  std::uint32_t device = 0;
  Load load;
};

/// Movement of one hand device during a stretch of time.
struct DeviceMotion {
  std::uint32_t device = 0;
  Motion motion;
};

inline constexpr double kStoodOnN = 100;               ///< 10 kg: somebody stands on it.
inline constexpr double kFreeN = board::kContactOffN;  ///< Nobody does.
inline constexpr double kShakenMps2 = 4;     ///< A deliberate shake, four times a slow gesture.
inline constexpr double kClearlyMore = 2.5;  ///< Ratio of the shaken device to every other.

/// The one board that is stood on while every other is free.
Pick WhichBoard(const std::vector<BoardLoad>& boards);
/// The one hand device that is shaken, clearly more than every other.
Pick WhichShaken(const std::vector<DeviceMotion>& devices);

// The items about devices. Each is a plain value; Advance() is called some twenty times a second.

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
  std::set<stream::DeviceRole> alone_;      ///< Roles of a device that is the only one of its kind.
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
