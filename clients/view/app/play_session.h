#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "clients/view/app/options.h"
#include "clients/view/app/recorded_show.h"
#include "clients/view/scene/align.h"
#include "clients/view/scene/play_head.h"

namespace footing::view {

/// One recording, or one of its trials, that is played.
struct PlayedSide {
  RecordedShow show;
  timeline::Timeline timeline;  ///< On the session's common zero.
  double zero_s = 0;            ///< That zero, on the recording's own timeline.
  std::string name;             ///< File and trial, for a person.
};

/// One recording, or two side by side, on one timeline with one play head.
class PlaySession {
 public:
  /// Opens what the options name. UsageError for a trial that is not there.
  static Result<PlaySession> Open(const PlayOptions& options, bool replay_falls);

  std::vector<PlayedSide>& sides() { return sides_; }
  const std::vector<PlayedSide>& sides() const { return sides_; }
  /// Of all sides.
  const timeline::Timeline& timeline() const { return timeline_; }
  timeline::PlayHead& head() { return head_; }
  const timeline::PlayHead& head() const { return head_; }

  /// Where a side stands at the head's position.
  timeline::SideState StateOf(const PlayedSide& side) const {
    return timeline::SideAt(side.timeline, head_.at_s);
  }
  /// What a side shows at the head's position.
  scene::Show::Shot ShotOf(PlayedSide& side, const scene::StageOptions& options) const;
  /// The recorder's clock of a side at the head's position.
  std::int64_t ClockOf(const PlayedSide& side) const;

 private:
  std::vector<PlayedSide> sides_;
  timeline::Timeline timeline_;
  timeline::PlayHead head_;
};

/// "FILE" or "FILE:TRIAL": the longest beginning that names a file is the file.
struct FileAndTrial {
  std::string file;
  std::string trial;  ///< Empty: none is named.
};
FileAndTrial SplitTrial(const std::string& text);

/// "start", "finish", "wall".
Result<timeline::Alignment> AlignmentNamed(const std::string& name);

}  // namespace footing::view
