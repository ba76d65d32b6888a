#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "common/body/body.h"
#include "common/net/lease_control.h"
#include "common/base/result.h"
#include "common/net/server.h"
#include "daemon/simulation/pose_service/config.h"
#include "daemon/simulation/pose_service/pose_events.h"
#include "daemon/simulation/pose_service/pose_run.h"
#include "daemon/simulation/pose_service/pose_sensors.h"
#include "daemon/simulation/pose_service/subject_body.h"
#include "daemon/simulation/serving/config.h"
#include "daemon/simulation/serving/simulation_thread.h"

namespace footing::pose_service {

/// The io side of the pose engine: board cells and hands in, a reconstructed person out (see
/// Service).
class PoseLine {
 public:
  using Run = PoseRun;
  static constexpr double kRateHz = 120;

  /// Reads the models and the subject file and builds the engine.
  static Result<std::unique_ptr<PoseLine>> Create(const serving::Config& common,
                                                  const Config& config, int wake_descriptor);

  static std::vector<transport::Channel> Channels();
  static std::vector<std::string> Capabilities() { return {"pose", "lease"}; }
  static std::vector<std::string> SensorChannels() {
    return {"status", "setup", "boards", "hands", "contacts", "motion"};
  }
  static constexpr v1::QueuePolicy kSensorPolicy = v1::QUEUE_POLICY_DROP_OLDEST;
  double frame_rate_hz() const { return kRateHz; }

  serving::SimulationThread<PoseRun>& thread() { return thread_; }
  std::vector<transport::ChannelBytes> Retained() const;
  void OnTick(const v1::Tick& tick, std::int64_t now_ns) { sensors_.OnTick(tick, now_ns); }
  /// CalibrateTPose, SetSubject and the lease; anything else is answered with what there is.
  v1::CommandResult OnCommand(const transport::SessionInfo& who, const v1::Command& command);
  void OnSessionEnd(const transport::SessionInfo& who) { lease_.EndSession(who.session); }
  std::vector<transport::ChannelBytes> OnFrame(const PoseFrame& frame, std::int64_t now_ns);

 private:
  /// A subject with the body that its frames are of.
  struct Known {
    std::uint64_t number = 0;
    Subject subject;
    body::Body body;
  };

  PoseLine(const serving::Config& common, const Config& config, reconstruction::Models models,
           reconstruction::Options options, Known first, std::unique_ptr<SubjectRun> run,
           int wake_descriptor);
  v1::CommandResult TakeSubject(const v1::SetSubject& message);
  const Known& Of(std::uint64_t number) const;

  const std::string world_ = "boards";
  const std::string mode_;
  const std::string effective_config_;  ///< JSON.
  const reconstruction::Models models_;
  const reconstruction::Options options_;
  std::deque<Known> known_;  ///< Oldest first; the newest is the one asked for last.
  std::uint64_t shown_number_;
  SubjectExchange subjects_;
  serving::SimulationThread<PoseRun> thread_;
  PoseSensors sensors_;
  PoseEvents events_;
  lease::LeaseControl lease_{"footing-sim"};
};

}  // namespace footing::pose_service
