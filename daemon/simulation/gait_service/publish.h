#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/stream/trial.h"
#include "daemon/simulation/engine/engine.h"
#include "footing/v1/character.pb.h"
#include "footing/v1/command.pb.h"

namespace footing::gait_service {

/// Engine inputs with where they came from.
struct Inputs {
  engine::EngineInputs engine;
  std::uint64_t sensor_epoch = 0;
  std::uint64_t sensor_sequence = 0;
};

/// Inputs as they took effect: from this step on.
struct Applied {
  std::uint64_t step = 0;
  Inputs inputs;
};

inline constexpr int kMaxApplied = 16;
inline constexpr int kMaxFrameEvents = 32;
inline constexpr int kMaxAdded = 64;

/// Frame that the simulation thread hands over some hundred times a second. Fixed size: filling and
/// moving it allocates nothing.
struct Frame {
  engine::EngineOutput output;
  std::uint64_t overruns = 0;
  std::uint64_t left_out = 0;  ///< Frames that were due and are not published.
  std::array<engine::EngineEvent, kMaxFrameEvents> events;  ///< Since the last frame.
  int event_count = 0;
  std::array<Applied, kMaxApplied> applied;  ///< Since the last frame.
  int applied_count = 0;
  std::array<stream::TrackSegment, kMaxAdded> added;  ///< To the track's end, since the last frame.
  int added_count = 0;
  std::int64_t command_ns = 0;  ///< When the gait command last changed.
  std::int64_t contact_ns = 0;  ///< When its controller took over.
};

/// From a frame of the simulation thread to the messages of the protocol.
v1::CharacterFrame ToCharacterFrame(const Frame& frame, const std::string& world,
                                    const std::string& rig);
v1::Event ToEvent(const engine::EngineEvent& event, std::int64_t host_ns);

/// Stamps of the features that arrived, by their number.
struct FeatureStamps {
  std::uint64_t number = 0;
  std::int64_t report_received_ns = 0;
  std::int64_t decoded_ns = 0;
  std::int64_t computed_ns = 0;
  std::int64_t received_ns = 0;
};

/// Follows each change of gait from the user's report to the first frame that shows it.
class Responses {
 public:
  void Received(const FeatureStamps& stamps) { Slot(stamps.number) = stamps; }

  /// Looks at a frame about to be published at `now_ns`; true when it is the first to show a new
  /// gait, with the stages in `stages`.
  bool Complete(const Frame& frame, std::int64_t now_ns, v1::ResponseStages& stages);

 private:
  static constexpr std::size_t kRemembered = 1024;
  FeatureStamps& Slot(std::uint64_t number) { return stamps_[number % kRemembered]; }

  std::array<FeatureStamps, kRemembered> stamps_{};
  std::uint64_t shown_step_ = 0;
  stream::Gait from_ = stream::Gait::kStep;
};

/// All failures of a run with what was corrected about them since. Nothing is forgotten: a failure
/// that was withdrawn only does not count.
class FailureRecord {
 public:
  /// Remembers a failure; `trial` is the id of its trial.
  v1::Failure Add(const engine::EngineEvent& event, const std::string& trial);

  /// Withdraws or restores a failure. Fails when there is none of that number.
  Result<void> Correct(const v1::CorrectFailure& message);
  /// The corrections since the last call, as events without a time.
  std::vector<v1::Event> TakeCorrections();

  /// The failures that are withdrawn at present: all of them, or those of one trial.
  const stream::FailureCounts& withdrawn() const { return withdrawn_; }
  stream::FailureCounts WithdrawnOf(std::uint64_t trial_number) const;

 private:
  struct Entry {
    v1::Failure failure;
    std::uint64_t trial_number = 0;
    bool in_trial = false;
  };

  /// Counts an entry that was withdrawn or restored just now.
  void CountWithdrawn(const Entry& entry);

  std::map<std::uint64_t, Entry> entries_;  ///< By their numbers.
  stream::FailureCounts withdrawn_;
  std::map<std::uint64_t, stream::FailureCounts> withdrawn_of_;  ///< By the numbers of trials.
  std::vector<v1::Event> corrections_;
};

}  // namespace footing::gait_service
