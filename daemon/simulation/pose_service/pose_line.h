#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/body/body.h"
#include "common/net/lease.h"
#include "common/net/server.h"
#include "common/runtime/config.h"
#include "daemon/simulation/pose_service/pose_run.h"
#include "daemon/simulation/pose_service/pose_sensors.h"
#include "daemon/simulation/pose_service/publish.h"
#include "daemon/simulation/reconstruction/models.h"
#include "daemon/simulation/reconstruction/reconstruction.h"
#include "daemon/simulation/serving/simulation_thread.h"
#include "footing/v1/character.pb.h"

namespace footing::pose_service {

/// Settings of the pose engine's service.
struct Config {
  std::string subject;  ///< Subject file; empty: nobody has been named.
  /// Folder of the subjects' own models, CODE.fmodel; empty: that of the subject file.
  std::string subject_models;
  std::string mode = "best";  ///< "best" or "paper".
  std::int64_t lag_ms = 0;    ///< 0, 100 or 200.
  /// Parts of the mode that are left out (reconstruction::LeaveOut).
  std::vector<std::string> leave_out;

  void Bind(config::Binder& binder);
};

/// Usage error that lists what there is when mode or lag is none of them.
Result<void> Check(const Config& config);

/// The models of the pose engine, and what a subject's own one makes of them.
class PoseModels {
 public:
  /// From `data_folder` (empty: the installed one): the prior of poses, and the networks of the
  /// horizontal COM, which only paper mode needs. One that is missing is an error that names it:
  /// nothing else takes its place. Only the arms' models may be missing; Wiimotes are not followed
  /// then, and said so. `subjects_folder`: of the subjects' own models; empty: they have none.
  static Result<PoseModels> Load(const std::string& data_folder, reconstruction::Mode mode,
                                 const std::string& subjects_folder);

  const reconstruction::Models& common() const { return common_; }
  /// Those that a subject is reconstructed with: the common ones, or as SUBJECTS/CODE.fmodel
  /// changes them, where there is such a file. InvalidData, which names the file, when it was made
  /// with another pose model or is of another person.
  Result<reconstruction::Models> Of(const std::string& code) const;
  /// File of a subject's own model; empty: none.
  std::string OwnFileOf(const std::string& code) const;

 private:
  std::string subjects_folder_;
  std::vector<reconstruction::NamedModel> files_;
  reconstruction::Models common_;
};

/// The io side of the pose engine: board cells and hands in, a reconstructed person out (see
/// Serving).
class PoseLine {
 public:
  using Run = PoseRun;
  static constexpr double kRateHz = 120;

  /// Reads the models and the subject file and builds the engine.
  static Result<std::unique_ptr<PoseLine>> Create(const serving::Config& common,
                                                  const Config& config, int wake_descriptor);

  /// Channels that it publishes.
  static std::vector<transport::Channel> Channels();
  static std::vector<std::string> Capabilities() { return {"pose", "lease"}; }
  static std::vector<std::string> SensorChannels() {
    return {"status", "setup", "boards", "hands", "contacts", "motion"};
  }
  static constexpr v1::QueuePolicy kSensorPolicy = v1::QUEUE_POLICY_DROP_OLDEST;
  double frame_rate_hz() const { return kRateHz; }

  serving::SimulationThread<PoseRun>& thread() { return thread_; }
  /// Channels that a new viewer needs, as of now.
  std::vector<transport::ChannelBytes> Retained() const;
  void OnTick(const v1::Tick& tick, std::int64_t now_ns) { sensors_.OnTick(tick, now_ns); }
  /// CalibrateTPose, SetSubject and the lease; anything else is answered with what there is.
  v1::CommandResult OnCommand(const transport::SessionInfo& who, const v1::Command& command);
  void OnSessionEnd(const transport::SessionInfo& who) { lease_.EndSession(who.session); }
  /// Channels to publish for a frame of the simulation thread.
  std::vector<transport::ChannelBytes> OnFrame(const PoseFrame& frame, std::int64_t now_ns);

 private:
  /// A subject with the body that its frames are of.
  struct Known {
    std::uint64_t number = 0;
    Subject subject;
    body::Body body;
    reconstruction::Options options;
    bool same_person = false;  ///< As the one before, in another mode.
  };

  PoseLine(const serving::Config& common, const Config& config, PoseModels models, Known first,
           std::unique_ptr<SubjectRun> run, int wake_descriptor);
  v1::CommandResult TakeSubject(const v1::SetSubject& message);
  v1::CommandResult TakeMode(const v1::SetPoseMode& message);
  /// The next one to be reconstructed, or the same person in another mode; `command` names it.
  v1::CommandResult Next(Known next, const std::string& command);
  const Known& Of(std::uint64_t number) const;

  const std::string world_ = "boards";
  const std::string effective_config_;  ///< JSON.
  const PoseModels models_;
  std::deque<Known> known_;  ///< Oldest first; the newest is the one asked for last.
  std::uint64_t shown_number_;
  SubjectExchange subjects_;
  serving::SimulationThread<PoseRun> thread_;
  PoseSensors sensors_;
  PoseEvents events_;
  lease::LeaseControl lease_{"footing-sim"};
};

inline constexpr const char* kPoseFile = "pose.fmodel";
inline constexpr const char* kComFile = "com.fmodel";
inline constexpr const char* kArmFile = "arm.fmodel";
inline constexpr const char* kPaperArmFile = "arm_paper.fmodel";

/// The inputs of the pose engine as they took effect, for recordings.
v1::AppliedInput ToAppliedInput(const PoseApplied& applied, const Subject& subject,
                                const reconstruction::Options& options, bool same_person = false);
/// The other way round, for replays.
PoseApplied PoseAppliedFrom(const v1::AppliedInput& message);
Subject SubjectFrom(const v1::AppliedInput& message);
/// `options` with the mode that they were for, and what it left out. InvalidData for one that this
/// program does not know.
Result<reconstruction::Options> OptionsFrom(const v1::AppliedInput& message,
                                            reconstruction::Options options);

}  // namespace footing::pose_service
