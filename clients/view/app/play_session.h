#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "clients/view/app/options.h"
#include "clients/view/app/recorded_show.h"
#include "clients/view/app/view_mouse.h"
#include "clients/view/render/hud.h"
#include "clients/view/render/screen.h"
#include "clients/view/scene/timeline.h"
#include "common/base/result.h"

struct GLFWwindow;

namespace footing::view {

struct WindowControls;

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
  /// Timeline of all sides.
  const timeline::Timeline& timeline() const { return timeline_; }
  timeline::PlayHead& head() { return head_; }
  const timeline::PlayHead& head() const { return head_; }

  /// Where a side stands at the head's position.
  timeline::SideState StateOf(const PlayedSide& side) const {
    return timeline::SideAt(side.timeline, head_.at_s);
  }
  /// Shot of a side at the head's position.
  scene::Show::Shot ShotOf(PlayedSide& side, const scene::StageOptions& options) const;
  /// The recorder's clock of a side at the head's position.
  std::int64_t ClockOf(const PlayedSide& side) const;

 private:
  std::vector<PlayedSide> sides_;
  timeline::Timeline timeline_;
  timeline::PlayHead head_;
};

/// A recording and a trial in it.
struct FileAndTrial {
  std::string file;
  std::string trial;  ///< Empty: none is named.
};
/// Splits "FILE" or "FILE:TRIAL": the longest beginning that names a file is the file.
FileAndTrial SplitTrial(const std::string& text);

/// Alignment of a name: "start", "finish", "wall".
Result<timeline::Alignment> AlignmentNamed(const std::string& name);

/// Plays in the window, until it is closed, Ctrl-C or options.seconds: then nothing; or until a
/// recording is dropped on it: that one. A recording that is over stays at its last state.
Result<std::optional<PlaySession>> PlayInWindow(GLFWwindow* window, const Options& options,
                                                PlaySession& session);

/// Opens the files that were dropped on a window: one, or two side by side. Says on `controls` why
/// it cannot; nothing where no files were dropped.
std::optional<PlaySession> TakeDropped(const Options& options, WindowControls& controls);

/// Plays options.play: into the window, into pictures, or as text.
Result<void> RunPlayback(const Options& options);

/// View options that a person has switched while a recording plays.
struct PlayPicture {
  render::HudOptions hud;
  bool timeline = true;
  scene::Orbit orbit = {};
  std::uint32_t followed = 0;  ///< Character that the camera follows; 0: the first.
};

/// View that the options ask for: for the subject neither panels nor timeline; side by side no
/// columns.
PlayPicture PictureFor(const Options& options, const PlaySession& session);

/// Draws all sides at the head's position into the bound framebuffer; returns where each is.
std::vector<DrawnView> DrawSession(render::Screen& screen, PlaySession& session,
                                   const PlayPicture& picture, int width, int height);

/// A screen with a world for each side.
Result<std::unique_ptr<render::Screen>> ScreenFor(const Options& options,
                                                  const PlaySession& session);

/// Draws options.screenshot at options.at_s, or pictures into options.record from the head on; each
/// at its exact position, however long it takes.
Result<void> DrawPlayedPictures(const Options& options, PlaySession& session);

/// The live state in the terminal: one screen redrawn four times a second, or, when standard output
/// is not a terminal, a line a second. Runs until Ctrl-C or options.seconds.
Result<void> RunTextView(const Options& options);

/// Intervals at which text is written, s: a terminal's screen, or a line elsewhere.
inline constexpr double kScreenEveryS = 0.25;
inline constexpr double kLineEveryS = 1;

/// True where the options and standard output want the redrawn screen, not lines.
bool WantsScreen(const Options& options);
/// One screen: clears the terminal first, says last how to leave.
std::string ScreenText(const std::vector<std::string>& lines);

}  // namespace footing::view
