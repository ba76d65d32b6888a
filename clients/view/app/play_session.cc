#include "clients/view/app/play_session.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <list>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <unistd.h>
#include <boost/asio/io_context.hpp>

#include "clients/view/app/feed.h"
#include "clients/view/app/glfw_window.h"
#include "clients/view/app/pictures.h"
#include "clients/view/app/play_summary.h"
#include "clients/view/app/speaker.h"
#include "clients/view/app/window.h"
#include "clients/view/render/screen.h"
#include "clients/view/render/target.h"
#include "clients/view/scene/clear_view.h"
#include "clients/view/scene/stage.h"
#include "clients/view/scene/text.h"
#include "clients/view/scene/timeline.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/net/address.h"
#include "common/runtime/clock.h"
#include "common/runtime/log.h"
#include "common/runtime/service_manager.h"
#include "common/runtime/timer.h"

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

namespace {

/// footing-sim publishes a hundred frames a second.
constexpr double kFrameS = 0.01;

/// GLFW's keys by the names of kPlayKeys.
constexpr std::array<std::pair<int, const char*>, 17> kKeyNames{{
    {GLFW_KEY_SPACE, "space"},
    {GLFW_KEY_LEFT, "left"},
    {GLFW_KEY_RIGHT, "right"},
    {GLFW_KEY_COMMA, ","},
    {GLFW_KEY_PERIOD, "."},
    {GLFW_KEY_UP, "up"},
    {GLFW_KEY_DOWN, "down"},
    {GLFW_KEY_EQUAL, "="},
    {GLFW_KEY_KP_ADD, "+"},
    {GLFW_KEY_MINUS, "-"},
    {GLFW_KEY_KP_SUBTRACT, "-"},
    {GLFW_KEY_N, "N"},
    {GLFW_KEY_P, "P"},
    {GLFW_KEY_T, "T"},
    {GLFW_KEY_HOME, "home"},
    {GLFW_KEY_END, "end"},
    {GLFW_KEY_KP_DECIMAL, "."},
}};

/// State that the callbacks of one window change.
struct PlayControls : WindowControls {
  explicit PlayControls(PlaySession& played) : session(played) {}
  PlaySession& session;
  bool with_timeline = true;
};

void OnPlayKey(GLFWwindow* window, int key, int, int action, int) {
  if (action != GLFW_PRESS && action != GLFW_REPEAT) return;
  auto& controls = static_cast<PlayControls&>(ControlsOf(window));
  PlaySession& session = controls.session;
  for (const auto& [code, name] : kKeyNames) {
    if (code != key) continue;
    const auto asked = timeline::ActionOf(name);
    if (!asked || (action == GLFW_REPEAT && *asked == timeline::PlayAction::kPause)) continue;
    session.head() = timeline::Act(session.head(), *asked, session.timeline(), kFrameS);
  }
  if (action != GLFW_PRESS) return;
  if (key == GLFW_KEY_L) controls.with_timeline = !controls.with_timeline;
  OnSharedKey(window, key);
}

PlayPicture PictureOf(const PlayControls& controls) {
  return {controls.hud, controls.with_timeline, controls.mouse.orbit(), controls.mouse.followed()};
}

Result<std::optional<PlaySession>> PlayLoop(GLFWwindow* window, const Options& options,
                                            render::Screen& screen, PlayControls& controls) {
  StopSignal stop;
  PictureTimes times;
  ViewSounds sounds(options.feedback.sound);
  PlaySession& session = controls.session;
  const std::int64_t started_ns = clock::MonotonicNs();
  std::int64_t last_ns = started_ns;
  double passed_s = 0;
  while (glfwWindowShouldClose(window) == GLFW_FALSE && !stop.asked() &&
         (options.seconds <= 0 || passed_s < options.seconds)) {
    glfwPollEvents();
    if (auto dropped = TakeDropped(options, controls)) return dropped;
    const std::int64_t now_ns = clock::MonotonicNs();
    if (!controls.seeking) {
      session.head() = timeline::Advanced(session.head(), NanosecondsToSeconds(now_ns - last_ns));
    }
    last_ns = now_ns;
    screen.set_display_scale(DisplayScale(window));
    controls.Refresh(window);
    const PixelSize size = BeginPicture(window);
    const std::vector<DrawnView> drawn =
        DrawSession(screen, session, PictureOf(controls), size.width, size.height);
    sounds.Follow(drawn);
    controls.mouse.SetViews(drawn, false);
    controls.timeline.reset();
    if (controls.with_timeline) {
      controls.timeline =
          render::TimelineBoxesOf(screen, size.width, size.height, session.sides().size());
    }
    EndPicture(window, now_ns, times);
    passed_s = NanosecondsToSeconds(clock::MonotonicNs() - started_ns);
  }
  if (options.json) std::cout << PlaySummary(session, passed_s, times) << std::endl;
  return std::optional<PlaySession>();
}

}  // namespace

std::optional<PlaySession> TakeDropped(const Options& options, WindowControls& controls) {
  const std::vector<std::string> files = std::exchange(controls.dropped, {});
  // The subject's screen shows the subject's task, whatever falls on it.
  if (files.empty() || options.subject) return std::nullopt;
  PlayOptions play;
  play.recording = files[0];
  if (files.size() > 1) play.beside = files[1];
  play.speed = options.play.speed;
  auto session = PlaySession::Open(play, options.replay_falls);
  if (session) return std::move(session).value();
  controls.Say(session.error().message);
  return std::nullopt;
}

Result<std::optional<PlaySession>> PlayInWindow(GLFWwindow* window, const Options& options,
                                                PlaySession& session) {
  auto screen = ScreenFor(options, session);
  if (!screen) return screen.error();
  PlayControls controls(session);
  const PlayPicture picture = PictureFor(options, session);
  controls.hud = picture.hud;
  controls.with_timeline = picture.timeline;
  controls.mouse.SetView(picture.orbit);
  controls.seek = [&](float column) {
    if (!controls.timeline) return;
    const double at_s = render::PositionAt(controls.timeline->groove, session.timeline(), column);
    session.head() = timeline::Sought(session.head(), at_s);
  };
  Listen(window, controls, OnPlayKey);
  glfwSetWindowTitle(window, ("Footing: " + session.sides().front().name).c_str());
  return PlayLoop(window, options, **screen, controls);
}

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
  if (HasDisplay()) return RunWindow(options, std::move(*session));
  log::Info("no display: showing the state as text (--screenshot draws without one)");
  return PlayAsText(options, *session);
}

namespace {

/// Trial at the head's position, as text for the timeline.
std::string TrialTextOf(const PlaySession& session) {
  std::string text;
  for (const PlayedSide& side : session.sides()) {
    const std::string trial = timeline::TrialText(side.timeline, session.StateOf(side).at_s);
    if (!text.empty() && !trial.empty()) text += "   |   ";
    text += trial;
  }
  return text;
}

}  // namespace

PlayPicture PictureFor(const Options& options, const PlaySession& session) {
  PlayPicture picture;
  picture.hud.hidden = options.subject;
  picture.hud.forces = options.forces;
  picture.hud.overlay_reference = options.overlay_reference;
  picture.hud.columns = session.sides().size() == 1;
  picture.hud.panels = options.look.panels;
  picture.orbit = options.look.orbit;
  picture.timeline = options.look.timeline && !options.subject;
  return picture;
}

std::vector<DrawnView> DrawSession(render::Screen& screen, PlaySession& session,
                                   const PlayPicture& picture, int width, int height) {
  const scene::StageOptions stage{picture.hud.forces, picture.hud.overlay_reference,
                                  picture.followed};
  const bool compared = session.sides().size() > 1;
  std::list<scene::Show::Shot> shots;
  std::vector<render::PlayedView> views;
  render::TimelineContent line{session.timeline(), {}, session.head(), TrialTextOf(session)};
  for (PlayedSide& side : session.sides()) {
    scene::Show::Shot& shot = shots.emplace_back(session.ShotOf(side, stage));
    shot.picture.camera = scene::ClearView(shot.picture, side.show.model().track, picture.orbit);
    const std::int64_t now_ns = session.ClockOf(side);
    views.push_back({{shot.picture, side.show.model(), shot.frame, now_ns, shot.past, shot.past_ns},
                     compared && !picture.hud.hidden ? side.name : "",
                     compared ? timeline::StateText(session.StateOf(side)) : ""});
    line.lanes.push_back(&side.timeline);
  }
  render::DrawPlayback(screen, views, picture.hud, picture.timeline ? &line : nullptr, width,
                       height);
  const std::vector<render::Box> boxes =
      render::PlaybackBoxesOf(screen, width, height, views.size(), picture.timeline);
  std::vector<DrawnView> drawn;
  for (std::size_t i = 0; i < views.size(); ++i) {
    drawn.push_back(ViewOf(screen, views[i].content, picture.hud, boxes[i]));
  }
  return drawn;
}

Result<std::unique_ptr<render::Screen>> ScreenFor(const Options& options,
                                                  const PlaySession& session) {
  auto screen = render::Screen::Create();
  if (!screen) return screen;
  (*screen)->set_ui_scale(static_cast<float>(options.look.ui_scale));
  for (std::size_t i = 1; i < session.sides().size(); ++i) {
    if (const auto added = (*screen)->AddWorld(); !added) return added.error();
  }
  return screen;
}

Result<void> DrawPlayedPictures(const Options& options, PlaySession& session) {
  auto context = render::OffScreen::Create();
  if (!context) return context.error();
  auto target = render::Target::Create(options.width, options.height, options.samples);
  if (!target) return target.error();
  auto screen = ScreenFor(options, session);
  if (!screen) return screen.error();
  const PlayPicture picture = PictureFor(options, session);
  const auto draw = [&] {
    target->Bind();
    DrawSession(**screen, session, picture, target->width(), target->height());
    return target->Read();
  };
  if (!options.screenshot.empty()) {
    const auto written = render::WritePicture(draw(), options.screenshot);
    if (written) log::Info("wrote " + options.screenshot);
    return written;
  }
  auto sink = PictureSink::Open(options.record, options.record_hz);
  if (!sink) return sink.error();
  const timeline::PlayHead from = session.head();
  const double left_s = (from.end_s - from.at_s) / from.speed;
  const double seconds = options.seconds > 0 ? std::min(options.seconds, left_s) : left_s;
  const auto count = static_cast<int>(seconds * options.record_hz) + 1;
  for (int i = 0; i < count; ++i) {
    session.head() = timeline::Advanced(from, i / options.record_hz);
    if (const auto written = sink->Add(draw()); !written) return written;
  }
  if (const auto finished = sink->Finish(); !finished) return finished;
  log::Info(sink->Written());
  return {};
}

namespace {

constexpr const char* kHomeAndClear = "\x1b[H\x1b[J";

/// Everything on one thread: a tick counts as seen when its handler runs.
class TextView {
 public:
  explicit TextView(const Options& options)
      : options_(options),
        started_ns_(clock::MonotonicNs()),
        screen_(WantsScreen(options)),
        timer_(io_),
        end_(io_, [this] { Stop(); }),
        feed_(io_, options,
              {[this](const scene::Update& update) { show_.Take(update, clock::MonotonicNs()); },
               [this](int source, const scene::LinkReport& report) {
                 show_.model().links[static_cast<std::size_t>(source)] = report;
               }}),
        preview_(io_, options.camera.address, [this](const scene::CameraPreview& preview) {
          show_.model().observed.camera = preview;
        }) {
    show_.model().links = Feed::InitialReports(options);
  }

  Result<void> Run() {
    feed_.Start();
    if (options_.camera.corner || options_.camera.alone) preview_.Start();
    WaitToDraw();
    io_.run();
    if (options_.json) std::cout << Summary(show_.model(), PassedS()) << std::endl;
    return WhyNothing();
  }

 private:
  /// Why nothing was seen: a server could be reached but did not let this viewer in, or none was
  /// there in the whole time that the viewer was given.
  Result<void> WhyNothing() {
    const scene::LinkReport* refused = nullptr;
    std::string waited_for;
    for (const scene::LinkReport& link : show_.model().links) {
      if (!link.server_id.empty()) return {};  // Another server was there.
      if (link.state == scene::LinkState::kRefused) refused = &link;
      waited_for += (waited_for.empty() ? "" : "; ") +
                    (link.why.empty() ? link.address + " does not answer" : link.why);
    }
    if (refused != nullptr) return Failure(refused->why);
    if (!time_is_up_ || options_.camera.alone) return {};
    return NoDevice("no server: " + waited_for +
                    transport::RemedyFor(
                        waited_for, "start footing-sim, or name where it listens with --connect"));
  }

  double PassedS() const { return NanosecondsToSeconds(clock::MonotonicNs() - started_ns_); }

  void WaitToDraw() {
    double wait_s = screen_ ? kScreenEveryS : kLineEveryS;
    if (options_.seconds > 0) wait_s = std::min(wait_s, options_.seconds - PassedS());
    timer_.After(std::max(wait_s, 0.0), [this] {
      Draw();
      time_is_up_ = options_.seconds > 0 && PassedS() >= options_.seconds;
      if (time_is_up_) return Stop();
      WaitToDraw();
    });
  }

  void Draw() {
    ++show_.model().tally.frames_drawn;
    const std::int64_t now_ns = clock::MonotonicNs();
    if (options_.camera.alone) return DrawCamera(now_ns);
    if (!screen_) {
      // With --json standard output is for the summary alone.
      std::ostream& out = options_.json ? std::cerr : std::cout;
      out << scene::StatusLine(show_.model(), now_ns) << std::endl;
      return;
    }
    std::cout << ScreenText(scene::StatusScreen(show_.model(), now_ns)) << std::endl;
  }

  void DrawCamera(std::int64_t now_ns) {
    std::ostream& out = options_.json ? std::cerr : std::cout;
    std::vector<std::string> lines;
    scene::AddPreviewLines(show_.model().observed.camera, now_ns, lines);
    out << (screen_ ? ScreenText(lines)
                    : scene::PreviewStatus(show_.model().observed.camera, now_ns))
        << std::endl;
  }

  void Stop() {
    feed_.Stop();
    io_.stop();
  }

  const Options& options_;
  std::int64_t started_ns_;
  bool screen_;
  bool time_is_up_ = false;
  boost::asio::io_context io_;
  timer::Timer timer_;
  service_manager::ProgramEnd end_;
  scene::Show show_;
  Feed feed_;
  PreviewLink preview_;
};

}  // namespace

bool WantsScreen(const Options& options) { return !options.json && isatty(STDOUT_FILENO) == 1; }

std::string ScreenText(const std::vector<std::string>& lines) {
  std::string text = kHomeAndClear;
  for (const std::string& line : lines) text += line + "\n";
  return text + "Ctrl-C leaves.";
}

Result<void> RunTextView(const Options& options) { return TextView(options).Run(); }

}  // namespace footing::view
