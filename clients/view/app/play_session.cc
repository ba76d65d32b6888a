#include "clients/view/app/play_session.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>
#include <utility>

#include "common/runtime/log.h"
#include "common/base/number.h"

namespace footing::view {
namespace {

/// The whole recording, or the one trial. `compared`: without a name the first trial is meant.
Result<PlayedSide> OpenSide(const FileAndTrial& what, bool compared) {
  auto recording = OpenForPlayback(what.file);
  if (!recording) return recording.error();
  auto marks = ReadMarks(*recording);
  if (!marks) return Error{marks.error().kind, marks.error().message};
  if (const std::string limits = recording->Limits(); !limits.empty()) {
    log::Warning(what.file + ": " + limits);
  }
  PlayedSide side{RecordedShow(std::move(*recording), *marks), marks->timeline, 0,
                  std::filesystem::path(what.file).filename().string()};
  const bool has_trials = !marks->timeline.trials.empty();
  if (what.trial.empty() && !(compared && has_trials)) return side;
  auto trial = what.trial.empty() ? Result<timeline::TrialMark>(marks->timeline.trials.front())
                                  : timeline::FindTrial(marks->timeline, what.trial);
  if (!trial) return Error{trial.error().kind, what.file + ": " + trial.error().message};
  side.timeline = timeline::Only(marks->timeline, *trial);
  side.zero_s = timeline::ZeroOf(side.timeline);
  side.name += "  " + timeline::NameOf(*trial);
  return side;
}

std::optional<std::int64_t> WallOfZero(const playback::SeekableRecording& recording) {
  const auto wall_ns = recording.wall_minus_clock_ns();
  if (!wall_ns) return std::nullopt;
  return *wall_ns + recording.first_ns();
}

}  // namespace

FileAndTrial SplitTrial(const std::string& text) {
  std::error_code none;
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || std::filesystem::exists(text, none)) return {text, ""};
  return {text.substr(0, colon), text.substr(colon + 1)};
}

Result<timeline::Alignment> AlignmentNamed(const std::string& name) {
  if (name == "start") return timeline::Alignment::kStart;
  if (name == "finish") return timeline::Alignment::kFinish;
  if (name == "wall") return timeline::Alignment::kWall;
  return UsageError("no alignment " + name + "; there are: start, finish, wall");
}

Result<PlaySession> PlaySession::Open(const PlayOptions& options, bool replay_falls) {
  PlaySession session;
  std::vector<FileAndTrial> files{{options.recording, options.trial}};
  if (!options.beside.empty()) files.push_back(SplitTrial(options.beside));
  for (const FileAndTrial& file : files) {
    auto side = OpenSide(file, files.size() > 1);
    if (!side) return side.error();
    if (replay_falls) side->show.ReplayFalls();
    session.sides_.push_back(std::move(*side));
  }
  std::vector<PlayedSide>& sides = session.sides_;
  if (sides.size() == 2) {
    std::array<timeline::Side, 2> aligned;
    for (std::size_t i = 0; i < 2; ++i) {
      aligned[i] = {sides[i].timeline, WallOfZero(sides[i].show.recording())};
    }
    const auto zeros = timeline::ZerosOf(aligned, options.alignment);
    if (!zeros) return zeros.error();
    for (std::size_t i = 0; i < 2; ++i) sides[i].zero_s = (*zeros)[i];
  }
  for (PlayedSide& side : sides) side.timeline = timeline::Shifted(side.timeline, side.zero_s);
  session.timeline_ = sides.size() == 2 ? timeline::Joined(sides[0].timeline, sides[1].timeline)
                                        : sides[0].timeline;
  session.head_ =
      timeline::HeadAt(session.timeline_.begin_s, session.timeline_.end_s, options.speed);
  if (options.from_s) {
    const timeline::Timeline& line = session.timeline_;
    if (*options.from_s < line.begin_s || *options.from_s > line.end_s) {
      return UsageError("the recording has no position " + text::Fixed(*options.from_s, 1) +
                        " s; it goes from " + text::Fixed(line.begin_s, 1) + " to " +
                        text::Fixed(line.end_s, 1) + " s");
    }
    session.head_ = timeline::Sought(session.head_, *options.from_s);
  }
  return session;
}

std::int64_t PlaySession::ClockOf(const PlayedSide& side) const {
  return side.show.TimeOf(StateOf(side).at_s + side.zero_s);
}

scene::Show::Shot PlaySession::ShotOf(PlayedSide& side, const scene::StageOptions& options) const {
  return side.show.At(ClockOf(side), options);
}

}  // namespace footing::view
