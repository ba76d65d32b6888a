#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/runtime/exchange.h"
#include "common/stream/character.h"
#include "daemon/simulation/biped/model.h"
#include "daemon/simulation/engine/state.h"
#include "daemon/simulation/gait_service/publish.h"
#include "footing/v1/character.pb.h"
#include "footing/v1/command.pb.h"

namespace footing::gait_service {

/// How tracks come to the simulation thread and go back: it never allocates or frees. A track takes
/// effect with the first inputs that carry its number; it is queued before them.
struct TrackExchange {
  static constexpr std::size_t kMost = 4;  ///< On their way at one time.

  exchange::BoundedQueue<std::unique_ptr<engine::TrackWorld>> next{kMost};
  exchange::BoundedQueue<std::unique_ptr<engine::TrackWorld>> done{kMost};
};

/// Begins and ends trials for clients, on the io thread: reads and builds their tracks, knows their
/// ids, and publishes what the engine says of them.
class TrialControl {
 public:
  struct Options {
    std::string track;        ///< Name or path of the first track.
    std::string data_folder;  ///< Where the built-in tracks are; empty: where they are installed.
    biped::BipedParameters biped;
    double step_s = 0.001;
  };

  /// `first` is the engine's present track.
  TrialControl(Options options, stream::Track first, TrackExchange& tracks);

  /// True for StartTrial, StopTrial and CorrectFailure.
  static bool Takes(const v1::Command& command);
  v1::CommandResult OnCommand(const v1::Command& command);
  /// Whichever it is, as StopTrial without a name.
  void StopNewest() { inputs_.stopped_below = trials_.back().number + 1; }
  /// Fails, with the reason, while a trial goes on: is on its way, ready or running; a server's
  /// first one, which has no id, from its start line on. StopTrial fails while none does.
  Result<void> CheckNoneGoesOn() const;
  /// For the engine, after a command.
  const engine::TrialInputs& inputs() const { return inputs_; }

  /// Follows the engine, after the frame's events; true when it runs on another track than in the
  /// frame before.
  bool OnFrame(const Frame& frame);
  /// The track of the last frame.
  stream::Track& track() { return trials_.front().track; }
  const stream::Track& track() const { return trials_.front().track; }

  /// An event of the engine as it is published; a failure is remembered.
  v1::Event ToEvent(const engine::EngineEvent& event, std::int64_t host_ns);
  /// Events of the corrections since the last call.
  std::vector<v1::Event> TakeCorrections(std::int64_t host_ns);
  /// Adds the trial to a character of the frame, and takes withdrawn failures out of its counts.
  void Describe(const Frame& frame, v1::Character& character) const;

 private:
  struct Trial {
    std::uint64_t number = 0;
    std::string id;
    std::uint64_t seed = 0;
    std::string track_name;
    stream::Track track;
  };

  Result<void> Start(const v1::StartTrial& message);
  Result<void> Stop(const v1::StopTrial& message);
  Result<stream::Track> Read(const std::string& name) const;
  bool GoesOn() const;
  const Trial& TrialNumbered(std::uint64_t number) const;
  v1::TrialState StateOf(const Trial& trial, const stream::TrialProgress& progress) const;

  const Options options_;
  TrackExchange& exchange_;
  engine::TrialInputs inputs_;
  stream::TrialPhase phase_ = stream::TrialPhase::kUnspecified;  ///< The last frame's trial.
  std::deque<Trial> trials_;  ///< The one of the last frame, and those on their way to the engine.
  FailureRecord failures_;
};

}  // namespace footing::gait_service
