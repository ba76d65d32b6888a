#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "clients/study/plan/phases.h"
#include "clients/study/session/console.h"
#include "clients/study/session/servers.h"
#include "clients/study/session/session_context.h"
#include "common/base/result.h"
#include "common/net/address.h"
#include "common/recording/mcap_records.h"
#include "common/recording/recording_writer.h"
#include "common/recording/stream_recorder.h"
#include "common/runtime/timer.h"
#include "common/stream/gait.h"
#include "common/stream/trial.h"

namespace footing::study {

/// Lead of the participant's command of a task's gait over the character's arrival at its line, s.
/// The gait paper asks whether "needed changes in behavior can be anticipated" (section 1), since
/// the character itself cannot answer at once.
class Anticipation {
 public:
  /// State of a task in one frame.
  struct Sight {
    std::int64_t host_ns = 0;
    double to_mark_m = 0;  ///< Left to the line; negative behind it.
    stream::Gait commanded = stream::Gait::kUnspecified;
    stream::Gait running = stream::Gait::kUnspecified;  ///< The character's.
    stream::Gait wanted = stream::Gait::kUnspecified;   ///< The task's.
  };
  /// Takes each frame, in order.
  void Add(const Sight& frame);

  /// Instant at the line less that of the command, of the newest approach, s: negative where the
  /// command came after the line. Ahead of the line the last command counts, behind it the first
  /// one, unless there was one ahead. Nothing before both.
  std::optional<double> seconds() const;

 private:
  std::int64_t command_ns_ = 0;
  std::int64_t line_ns_ = 0;
  bool commanded_ = false;
  bool ahead_ = false;
  bool answered_ = false;  ///< This approach has its command.
};

/// State of one trial, from the frames of footing-sim, whoever ends it.
class TrialTracker {
 public:
  explicit TrialTracker(std::string trial) : trial_(std::move(trial)) {}

  /// Takes each frame, in order; true when the frame belongs to the trial.
  bool Add(const stream::TrialState& frame);

  /// State in the newest frame of the trial.
  const stream::TrialState& state() const { return state_; }
  bool begun() const { return state_.trial == trial_; }
  bool finished() const { return state_.progress.phase == stream::TrialPhase::kFinished; }
  /// Finished, stopped, or another trial has taken its place.
  bool over() const;
  /// Outcome of a trial that ends now: "finished" if the character reached the finish line, else
  /// `reason`.
  std::string Outcome(const std::string& reason) const;

 private:
  std::string trial_;
  stream::TrialState state_;
  bool replaced_ = false;
};

/// Records a trial as footing-sim publishes it: failures, corrections and responses go into the
/// journal as they come, the rest adds up to the figures of the trial's end.
class TrialEvents {
 public:
  TrialEvents(SessionContext& context, Servers& servers, std::string id);
  ~TrialEvents();
  TrialEvents(const TrialEvents&) = delete;
  TrialEvents& operator=(const TrialEvents&) = delete;

  /// Listens from here on.
  void Begin();
  /// From here on takes corrections alone.
  void End() { ended_ = true; }
  const std::string& trial() const { return id_; }

  const TrialTracker& tracker() const { return tracker_; }
  /// The first event that could not be written.
  const Result<void>& written() const { return written_; }

  /// Figures for the event that ends the trial.
  nlohmann::ordered_json Figures() const;

 private:
  void OnFrame(const SimulationFrame& frame);
  void OnEvent(const v1::Event& event);
  void OnCorrection(const v1::Failure& failure);
  void OnFailure(const v1::Event& event);
  void OnResponse(const v1::ResponseStages& response);
  void Append(records::EventKind kind, nlohmann::ordered_json fields);

  SessionContext& context_;
  Servers& servers_;
  std::string id_;
  TrialTracker tracker_;
  HeadingOscillation heading_;
  Anticipation anticipation_;
  bool ended_ = false;
  Result<void> written_;
};

/// Runs one attempt at a trial: begins the recording and the trial, writes every failure into the
/// journal, and ends both. Returns the outcome: "finished", "timed_out" or "stopped". Keys during
/// an attended trial: s stops it, u undoes the latest failure. `events` carries the trial's id and
/// goes on listening to corrections. `on_placed` is called once the character stands at the start.
Result<std::string> RunTrial(SessionContext& context, Servers& servers, const ActiveTime& active,
                             TrialEvents& events, const plan::Phase& phase, std::size_t attempt,
                             std::function<void()> on_placed);

/// Puts the character at the start of a track, for demonstration and practice.
Result<void> PlaceOnTrack(Servers& servers, const std::string& id, const plan::Phase& phase);

/// Records everything that both servers publish during one trial, in one file (MCAP) as footing-log
/// does. It has connections of its own: each begins with what is retained, such as the track, and a
/// slow disk disturbs no other connection.
class TrialRecorder {
 public:
  struct Options {
    std::string path;  ///< Must not exist.
    std::string version;
    std::vector<transport::Address> addresses;
    std::vector<std::pair<std::string, std::string>> attachments;  ///< Name and text.
  };

  /// `marks` is the metadata record "trial".
  static Result<std::unique_ptr<TrialRecorder>> Begin(Console& console, const Options& options,
                                                      const mcap::TextMap& marks);
  ~TrialRecorder();
  TrialRecorder(const TrialRecorder&) = delete;
  TrialRecorder& operator=(const TrialRecorder&) = delete;

  /// Returns when something of every server has arrived.
  Result<void> AwaitFirst(Console& console) const;
  /// A full disk, as soon as it is noticed.
  const Result<void>& written() const { return written_; }
  /// Runs until everything up to this instant is in the file, for a short while at most: events
  /// reach other connections first. A server with another clock is waited for in vain.
  Waited CatchUp(Console& console, std::int64_t host_ns) const;
  /// Ends the file; `outcome` is the metadata record "trial_outcome".
  Result<void> Finish(const mcap::TextMap& outcome);

 private:
  TrialRecorder(Console& console, recording::RecordingWriter writer)
      : writer_(std::move(writer)), flush_(console.io()) {}
  Result<void> Describe(const Options& options, const mcap::TextMap& marks);
  /// Whether every server's recorder does; true, too, once something could not be written.
  template <typename Does>
  bool EveryServer(const Does& does) const;
  void Keep(Result<void> written);
  void FlushLater();

  recording::RecordingWriter writer_;
  recording::ServerNames names_;
  std::vector<std::unique_ptr<recording::ServerRecorder>> servers_;
  Result<void> written_;
  timer::Timer flush_;
};

/// Takes a failure of an attempt out of the counts: with footing-sim as long as that shows the
/// attempt, whose events must be listened to (TrialEvents), otherwise in the journal alone. What
/// prevents it is printed; an error ends the session.
Result<void> UndoFailure(SessionContext& context, Servers& servers, const std::string& trial,
                         std::uint64_t number);

/// Undoes the newest failure of the attempt that counts.
Result<void> UndoNewest(SessionContext& context, Servers& servers, const std::string& trial);

}  // namespace footing::study
