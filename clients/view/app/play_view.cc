#include "clients/view/app/play_view.h"

#include <iostream>

#include "clients/view/app/play_pictures.h"
#include "clients/view/app/play_session.h"
#include "clients/view/app/play_summary.h"
#include "clients/view/app/play_window.h"
#include "clients/view/app/stop_signal.h"
#include "clients/view/app/text_view.h"
#include "clients/view/app/window.h"
#include "clients/view/scene/timeline_text.h"
#include "common/runtime/clock.h"
#include "common/runtime/log.h"
#include "common/base/units.h"

namespace footing::view {
namespace {

constexpr double kMoveEveryS = 0.05;

/// Brings every side to the head's position.
void Move(PlaySession& session) {
  for (PlayedSide& side : session.sides()) session.ShotOf(side, {});
}

void Write(const Options& options, const PlaySession& session, bool screen) {
  if (!screen) {
    // With --json standard output is for the summary alone.
    (options.json ? std::cerr : std::cout) << PlayLine(session) << std::endl;
    return;
  }
  std::cout << ScreenText(PlayScreenText(session)) << std::endl;
}

/// Plays to the end, or shows the one position of --at.
double PlayText(const Options& options, PlaySession& session) {
  StopSignal stop;
  const bool screen = !options.at_s && WantsScreen(options);
  const timeline::PlayHead from = session.head();
  const std::int64_t started_ns = clock::MonotonicNs();
  double passed_s = 0, written_s = -kLineEveryS;
  for (;;) {
    session.head() = timeline::Advanced(from, passed_s);
    Move(session);
    const bool over = options.at_s || session.head().ended() || stop.asked() ||
                      (options.seconds > 0 && passed_s >= options.seconds);
    if (over || passed_s - written_s >= (screen ? kScreenEveryS : kLineEveryS)) {
      Write(options, session, screen);
      written_s = passed_s;
    }
    if (over) return passed_s;
    clock::SleepUntil(started_ns + SecondsToNanoseconds(passed_s + kMoveEveryS));
    passed_s = NanosecondsToSeconds(clock::MonotonicNs() - started_ns);
  }
}

/// All marks, before the lines of what plays; with --json they are in the summary.
void WriteMarks(const Options& options, const PlaySession& session) {
  if (options.json || WantsScreen(options)) return;
  for (const PlayedSide& side : session.sides()) {
    std::cout << side.name << "\n";
    for (const std::string& line : timeline::MarkLines(side.timeline)) std::cout << line << "\n";
  }
}

Result<void> PlayAsText(const Options& options, PlaySession& session) {
  WriteMarks(options, session);
  const double passed_s = PlayText(options, session);
  if (options.json) std::cout << PlaySummary(session, passed_s) << std::endl;
  return {};
}

}  // namespace

Result<void> RunPlayback(const Options& options) {
  auto session = PlaySession::Open(options.play, options.replay_falls);
  if (!session) return session.error();
  if (options.off_screen()) {
    const std::int64_t started_ns = clock::MonotonicNs();
    const auto drawn = DrawPlayedPictures(options, *session);
    if (drawn && options.json) {
      std::cout << PlaySummary(*session, NanosecondsToSeconds(clock::MonotonicNs() - started_ns))
                << std::endl;
    }
    return drawn;
  }
  if (options.text) return PlayAsText(options, *session);
  if (HasDisplay()) return RunPlayWindow(options, *session);
  log::Info("no display: showing the state as text (--screenshot draws without one)");
  return PlayAsText(options, *session);
}

}  // namespace footing::view
