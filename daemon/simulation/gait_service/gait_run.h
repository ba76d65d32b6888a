#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/base/result.h"
#include "common/net/lease.h"
#include "common/net/server.h"
#include "common/runtime/exchange.h"
#include "common/stream/character.h"
#include "daemon/simulation/gait_service/config.h"
#include "daemon/simulation/gait_service/input_collector.h"
#include "daemon/simulation/gait_service/publish.h"
#include "daemon/simulation/gait_service/relays.h"
#include "daemon/simulation/gait_service/trial_control.h"
#include "daemon/simulation/serving/simulation_thread.h"

namespace footing::gait_service {

/// The gait engine on the simulation thread (see SimulationThread).
class GaitRun {
 public:
  using Inputs = gait_service::Inputs;
  using Frame = gait_service::Frame;

  GaitRun(engine::GaitEngine engine, TrackExchange& tracks)
      : engine_(std::move(engine)), tracks_(&tracks) {}

  /// One step, with new inputs where there are any.
  void StepOnSimThread(exchange::Latest<Inputs>& inputs, Frame& frame);
  void FillOnSimThread(Frame& frame) { frame.output = engine_.Output(); }
  void TakenOnSimThread(Frame& frame) const;

  const engine::GaitEngine& engine() const { return engine_; }

 private:
  void UseTrackOnSimThread(std::uint64_t number, Frame& frame);

  engine::GaitEngine engine_;
  TrackExchange* tracks_;
};

/// The io side of the gait engine: features in, a walking biped out (see Serving).
class GaitLine {
 public:
  using Run = GaitRun;

  /// Reads the data files and builds the engine.
  static Result<std::unique_ptr<GaitLine>> Create(const serving::Config& common,
                                                  const Config& config, int wake_descriptor);

  /// Channels that it publishes.
  static std::vector<transport::Channel> Channels();
  /// The engine, its interfaces, and trials.
  static std::vector<std::string> Capabilities();
  /// Those of all interfaces: another may be chosen at any time.
  static std::vector<std::string> SensorChannels() {
    return {"status", "setup", "features", "motion", "nunchuk", "boards"};
  }
  static constexpr v1::QueuePolicy kSensorPolicy = v1::QUEUE_POLICY_DROP_OLDEST;
  double frame_rate_hz() const { return frame_rate_hz_; }

  serving::SimulationThread<GaitRun>& thread() { return thread_; }
  /// Channels that a new viewer needs, as of now.
  std::vector<transport::ChannelBytes> Retained() const;
  void OnTick(const v1::Tick& tick, std::int64_t now_ns) { input_.OnTick(tick, now_ns); }
  /// Carries out a command of a session, if it has the lease that the command needs.
  v1::CommandResult OnCommand(const transport::SessionInfo& who, const v1::Command& command);
  void OnSessionEnd(const transport::SessionInfo& who) {
    game_.OnSessionEnd(who);
    EndLeftGame();
    study_.OnSessionEnd(who);
    lease_.EndSession(who.session);
    input_.OnSessionEnd(who.session);
  }
  /// Channels to publish for a frame of the simulation thread.
  std::vector<transport::ChannelBytes> OnFrame(const Frame& frame, std::int64_t now_ns);

 private:
  GaitLine(const std::string& rig, const Config& config, engine::GaitEngine engine,
           TrialControl::Options trial_options, EffectiveConfig effective, int wake_descriptor);
  Result<void> SetInterface(const transport::SessionInfo& who, const v1::SetInterface& message);
  /// Stops the trial of a game whose leader has gone: the runner would run off its track's end.
  void EndLeftGame();
  /// Adds the changes of the retained channels since the last frame.
  void AddChanges(const Frame& frame, bool switched, std::int64_t now_ns,
                  std::vector<transport::ChannelBytes>& channels);
  v1::Events EventsOf(const Frame& frame, std::int64_t now_ns);

  const std::string world_;
  const std::string data_folder_;
  const double frame_rate_hz_;
  Responses responses_;
  TrackExchange tracks_;  // Before the thread, which uses it.
  serving::SimulationThread<GaitRun> thread_;
  TrialControl trials_;
  lease::LeaseControl lease_{"footing-sim"};
  SensorInput input_;
  GameRelay game_;
  StudyRelay study_;
  EffectiveConfig effective_;
  bool config_changed_ = false;
};

}  // namespace footing::gait_service
