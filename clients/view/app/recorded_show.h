#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "clients/view/scene/stage.h"
#include "clients/view/scene/timeline.h"
#include "clients/view/scene/update.h"
#include "common/base/result.h"
#include "common/recording/seekable_recording.h"
#include "footing/v1/session.pb.h"

namespace footing::view {

/// The servers of a recording that are shown, in the order of the default addresses.
const std::vector<std::string>& PlayedServers();
inline constexpr std::size_t kPlayedSimulation = 0;
inline constexpr std::size_t kPlayedSensors = 1;

/// Opens a recording for playback: those servers, with the channels that the viewer shows.
Result<playback::SeekableRecording> OpenForPlayback(const std::string& path);

/// Events of a recording: trials, failures, tasks, in seconds from its first tick; and the times of
/// gait changes, responses and notes, which a seek needs.
struct RecordedMarks {
  timeline::Timeline timeline;
  std::vector<std::int64_t> gait_changes_ns;  ///< Sorted by time, as the others.
  std::vector<std::int64_t> responses_ns;     ///< Times of the ticks that brought one.
  std::vector<std::int64_t> notes_ns;         ///< Times of the ticks that brought a text to read.
};

/// Reads all events once. InvalidData when there are more than the limits of timeline.h allow.
Result<RecordedMarks> ReadMarks(playback::SeekableRecording& recording);

/// The scene of a recording at any of its instants.
///
/// The clock of its scene is the recorder's, so slow motion and pauses slow down all that moves.
/// The picture at an instant depends on that instant alone: the scene moves on in steps of 1/60 s
/// that are counted from the recording's start, and after a seek it is built from what it shows of
/// the past (SeekSpans). Only the counts of scene::Tally and PoseTally are of what was played.
class RecordedShow {
 public:
  RecordedShow(playback::SeekableRecording recording, RecordedMarks marks);

  /// Each fall is shown again in slow motion as soon as it is over.
  void ReplayFalls() { replays_falls_ = true; }

  /// The scene as it was at `time_ns` of the recorder's clock. A little later than before, it plays
  /// on; anywhere else it seeks.
  scene::Show::Shot At(std::int64_t time_ns, const scene::StageOptions& options);

  const scene::Model& model() const { return show_->model(); }
  scene::Model& model() { return show_->model(); }
  const playback::SeekableRecording& recording() const { return recording_; }
  const timeline::Timeline& timeline() const { return marks_.timeline; }

  /// The recorder's clock at a position of the timeline, and back.
  std::int64_t TimeOf(double position_s) const;

 private:
  using Span = std::pair<std::int64_t, std::int64_t>;

  void Seek(std::int64_t time_ns, const scene::StageOptions& options);
  std::vector<Span> SeekSpans(std::int64_t time_ns);
  void ApplyRetained(std::int64_t time_ns);
  void ApplyLastNotes(std::int64_t before_ns);
  /// Takes all ticks from where it stands to `to_ns`, and steps where `steps`.
  void PlayTo(std::int64_t to_ns, bool steps, const scene::StageOptions& options);
  void Take(const playback::PlacedTick& placed);
  void ReportLinks(std::int64_t time_ns);

  playback::SeekableRecording recording_;
  RecordedMarks marks_;
  std::unique_ptr<scene::Show> show_;
  bool replays_falls_ = false;
  std::int64_t taken_to_ns_ = 0;         ///< All ticks before this were taken.
  std::int64_t stepped_to_ns_ = 0;       ///< The last step; 0 before the first.
  std::vector<std::int64_t> newest_ns_;  ///< Newest tick of each server so far.
  std::uint64_t track_version_ = 0;      ///< Counts on over seeks: another one is another track.
};

/// A tick as plain structs. Stamps of the server's clock are moved by -offset_ns onto the viewer's
/// own. Numbers that are not finite become 0 on the way.
scene::Update Translate(const v1::Tick& tick, int source, std::int64_t received_ns,
                        std::int64_t offset_ns);

/// Notice of a cause that slows a server or this session, as a note.
scene::Update TranslateNotice(const v1::Notice& notice, int source, std::int64_t received_ns);

}  // namespace footing::view
