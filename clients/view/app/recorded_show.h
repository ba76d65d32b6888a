#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "clients/view/app/recorded_marks.h"
#include "clients/view/scene/show.h"
#include "common/recording/seekable_recording.h"

namespace footing::view {

/// The scene of a recording at any of its instants.
///
/// The clock of its scene is the recorder's, so slow motion and pauses slow down all that moves.
/// What is shown at an instant depends on that instant alone: the scene moves on in steps of 1/60 s
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
  void TakeRetained(std::int64_t time_ns);
  void TakeLastNotes(std::int64_t before_ns);
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
  std::vector<std::int64_t> newest_ns_;  ///< Of each server's ticks so far.
  std::uint64_t track_version_ = 0;      ///< Counts on over seeks: another one is another track.
};

}  // namespace footing::view
