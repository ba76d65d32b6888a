#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/base/result.h"
#include "daemon/sensor/service/config.h"
#include "daemon/sensor/service/rigs.h"
#include "daemon/sensor/setup/setup_store.h"

namespace footing::sensor {

/// Measurement by a command.
struct Measured {
  double residual = 0;
  std::string unit;
  std::string message;
};

/// The set-up of all rigs: what is stored, which part of it holds for which device, alarms about
/// it, and the prompts of guided set-ups. What a command changes is saved at once and holds from
/// the end of the next tick on, so that a recording's reports and set-up give the same features
/// again.
class SetupKeeper {
 public:
  /// Config and devices are borrowed.
  SetupKeeper(const Config& config, const DeviceTable& devices, setup::Storage storage,
              std::function<void(const LogLine&)> log, std::function<std::int64_t()> now_ns)
      : config_(config),
        devices_(devices),
        store_(std::move(storage)),
        log_(std::move(log)),
        now_ns_(std::move(now_ns)) {}

  /// The mean of the board's newest `window_s` (0: 2 s) becomes its zero; or it is forgotten.
  Result<Measured> Tare(const std::string& serial, double window_s, bool clear);
  /// Rotation from S to M of a device on the body, residual in degrees; an error when unusable.
  Result<Measured> SolveMounting(const std::string& serial, const MountingStretches& stretches);
  Result<Measured> ClearMounting(const std::string& serial);
  /// Places of a rig's boards on the floor; an error names what does not fit.
  Result<Measured> SetBoardLayout(stream::BoardLayout layout);
  /// Notes that a step of the set-up was done, or forgets it.
  Result<void> RecordSetup(const std::string& rig, const stream::SetupItem& item, bool forget);
  /// Published with the rig's set-up until the session ends; nothing: no more is asked for.
  Result<void> ShowPrompt(std::uint64_t session, const std::string& rig,
                          const std::optional<stream::SetupPrompt>& prompt);
  /// A mounting found for this role, now or in a recording.
  void StoreMounting(const Binding& binding, const stream::DeviceMounting& mounting);
  /// Roles that a command gave outlive a restart.
  void StoreRole(const std::string& serial, const Binding& binding);
  const setup::Roles& roles() const { return store_.roles(); }
  /// Releases the session's prompts.
  void EndSession(std::uint64_t session);

  /// Gives the device its tare and mounting; true when its samples are in another frame from now
  /// on.
  bool Apply(Device& device) const;
  /// Whether what is stored changed since the last call, so that it has to be applied to all.
  bool Changed();
  /// The set-up in force, to be published with this tick; nothing when it stayed as it was.
  std::optional<std::vector<stream::RigSetup>> Publish();
  /// Stores the alarms that the devices' own watches raise, until that part is done again; true
  /// when a device's status changed.
  bool Watch();
  void AddTo(decode::Placement placement, stream::DeviceStatus& status) const;

 private:
  struct ShownPrompt {
    std::uint64_t session = 0;
    stream::SetupPrompt prompt;
  };

  Result<Device*> AttachedOnBody(const std::string& serial) const;
  std::vector<stream::RigSetup> InForce() const;
  bool WatchLayouts();
  std::string BoardNote(const stream::DeviceStatus& status) const;

  const Config& config_;
  const DeviceTable& devices_;
  setup::SetupStore store_;
  std::function<void(const LogLine&)> log_;
  std::function<std::int64_t()> now_ns_;
  std::map<std::string, ShownPrompt> prompts_;  ///< By rig.
  std::uint64_t last_prompt_ = 0;
  bool due_ = false;  ///< To be published with the next tick.
  std::uint64_t applied_revision_ = 0;
  std::set<std::string> published_board_rigs_;
  std::set<std::string> crowded_rigs_;  ///< With more boards than their layout has places.
};

}  // namespace footing::sensor
