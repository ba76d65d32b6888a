#pragma once

#include <cstdint>
#include <string>

#include "common/runtime/latest.h"
#include "daemon/simulation/gait_service/frame.h"
#include "daemon/simulation/gait_service/input_collector.h"
#include "daemon/simulation/gait_service/responses.h"
#include "footing/v1/command.pb.h"
#include "footing/v1/session.pb.h"

namespace footing::gait_service {

/// Turns sensor ticks and commands into engine inputs, on the io thread.
class SensorInput {
 public:
  /// `rig` empty: the first rig with a device that the interface uses.
  SensorInput(std::string rig, const mapping::InterfaceOptions& options,
              exchange::Latest<Inputs>& out, Responses& responses);

  /// Each live tick is new to the engine, also one in which all devices of the rig are silent: that
  /// footingd answers and says so is not the same as that nothing comes from it.
  void OnTick(const v1::Tick& tick, std::int64_t now_ns);
  /// What the engine has done with the inputs so far.
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
  FeatureStamps stamps_;              ///< Of the newest that was not silence.
  std::uint64_t appends_taken_ = 0;   ///< Or refused, by the engine.
  std::uint64_t direct_session_ = 0;  ///< Of the newest DirectGait.
};

}  // namespace footing::gait_service
