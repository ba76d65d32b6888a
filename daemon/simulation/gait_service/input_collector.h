#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/base/result.h"
#include "common/rig/follower.h"
#include "common/runtime/exchange.h"
#include "common/stream/user_interface.h"
#include "daemon/simulation/gait_service/publish.h"
#include "daemon/simulation/mapping/any_interface.h"
#include "footing/v1/command.pb.h"
#include "footing/v1/session.pb.h"

namespace footing::gait_service {

/// Collects what one rig's controllers and boards send into the inputs of a user interface, on the
/// io thread. A stick or a board without samples for longer than kTimeoutS is not present, and
/// neither is a controller when the rig has had no features for longer than kFeaturesTimeoutS.
/// Samples that are not finite count as none.
class InputCollector {
 public:
  static constexpr double kTimeoutS = 0.25;
  static constexpr double kFeaturesTimeoutS = 0.5;

  /// `rig` empty: the first rig with a device that the interface uses.
  InputCollector(std::string rig, const mapping::InterfaceOptions& options)
      : options_(options), sensors_(std::move(rig), stream::DrivingRoles(options.interface)) {}

  /// Goes over to another interface: on the rig that it follows or, where the constructor named
  /// none, on the first one that has the roles for it. Fails, and names what is missing, when none
  /// does; the interface before then stays.
  Result<void> Use(const mapping::InterfaceOptions& options);

  /// Takes a live tick or a snapshot in; true when it brought, or ended, something of the rig.
  bool Take(const v1::Tick& tick, std::int64_t now_ns);

  const std::string& rig() const { return sensors_.rig(); }
  const mapping::InterfaceOptions& options() const { return options_; }
  const mapping::Inputs& inputs() const { return inputs_; }
  /// When the newest of it was made; its number is not filled in. Of a stick and a board only
  /// the sample's and the tick's stamps are known.
  const FeatureStamps& stamps() const { return stamps_; }

 private:
  /// The hand whose Wiimote has the stick, or may have it; unspecified where that is not known.
  stream::DeviceRole StickRole() const;
  /// The rig for an interface, by its devices; else what is missing.
  Result<std::string> RigFor(const mapping::InterfaceOptions& options) const;
  bool TakeFeatures(const rig::Tick& tick);
  bool TakeStick(const rig::Tick& tick, std::int64_t now_ns);
  bool TakeBoards(const rig::Tick& tick, std::int64_t now_ns);
  /// Drops inputs not heard of for too long; true when that is new.
  bool Expire(std::int64_t now_ns);

  mapping::InterfaceOptions options_;
  rig::Follower sensors_;
  mapping::Inputs inputs_;
  FeatureStamps stamps_;
  std::uint32_t stick_device_ = 0;
  rig::LastHeard features_, stick_, left_board_, right_board_;
};

/// Turns sensor ticks and commands into engine inputs, on the io thread.
class SensorInput {
 public:
  /// `rig` empty: the first rig with a device that the interface uses.
  SensorInput(std::string rig, const mapping::InterfaceOptions& options,
              exchange::Latest<Inputs>& out, Responses& responses);

  /// Each live tick is new to the engine, also one in which all devices of the rig are silent: that
  /// footingd answers and says so is not the same as that nothing comes from it.
  void OnTick(const v1::Tick& tick, std::int64_t now_ns);
  /// The engine's report on the inputs so far.
  void OnFrame(const Frame& frame) { appends_taken_ = frame.output.append.number; }
  /// DirectGait, Push, PutBack and AppendSegment; anything else is answered with what there is.
  v1::CommandResult OnCommand(const v1::Command& command, std::uint64_t session);
  /// Releases the gait that the session commanded directly: nobody would stop the character.
  void OnSessionEnd(std::uint64_t session);

  /// Another interface, from now on. Refused, with the reason, where the devices do not fit.
  Result<void> SetInterface(const mapping::InterfaceOptions& options,
                            const mapping::AnyInterface& made);
  /// Which trial runs, from now on.
  void SetTrial(const engine::TrialInputs& trial) {
    inputs_.engine.trial = trial;
    Publish();
  }

  const std::string& rig() const { return collector_.rig(); }
  /// Counts the changes of the interface.
  std::uint64_t interface_number() const { return inputs_.engine.interface.number; }
  const mapping::InterfaceOptions& interface() const { return collector_.options(); }

 private:
  v1::CommandResult Append(const v1::AppendSegment& message);
  void Publish() { out_.Write(inputs_); }

  InputCollector collector_;
  exchange::Latest<Inputs>& out_;
  Responses& responses_;
  Inputs inputs_;
  FeatureStamps stamps_;              ///< Stamps of the newest that was not silence.
  std::uint64_t appends_taken_ = 0;   ///< Or refused, by the engine.
  std::uint64_t direct_session_ = 0;  ///< Session of the newest DirectGait.
};

}  // namespace footing::gait_service
