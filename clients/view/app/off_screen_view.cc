#include "clients/view/app/off_screen_view.h"

#include <iostream>

#include "clients/view/app/background.h"
#include "clients/view/app/pictures.h"
#include "clients/view/app/pose_calibration.h"
#include "clients/view/app/summary.h"
#include "clients/view/render/off_screen.h"
#include "clients/view/render/screen.h"
#include "clients/view/render/target.h"
#include "common/runtime/clock.h"
#include "common/runtime/log.h"
#include "common/base/number.h"
#include "common/net/run_folder.h"
#include "common/base/units.h"

namespace footing::view {
namespace {

constexpr double kStepS = 1.0 / 60;
constexpr double kAtS = 1;         // Without --at.
constexpr double kRecordS = 10;    // Without --seconds.
constexpr double kAnnouncedS = 2;  // A longer wait for a picture is announced.

/// The chain of one off-screen run; its members' order is their order of construction.
struct Studio {
  const Options& options;
  render::Target& target;
  render::Screen& screen;
  Background& background;
  PoseCalibration* calibration = nullptr;
  scene::Show show = {};
  std::int64_t started_ns = clock::MonotonicNs();

  double PassedS() const { return NanosecondsToSeconds(clock::MonotonicNs() - started_ns); }

  double AtS() const { return options.at_s.value_or(kAtS); }

  /// Lets the camera and the head follow until that instant of the viewer's clock.
  scene::Show::Shot FollowUntil(std::int64_t until_ns) {
    for (;;) {
      background.Drain(show, calibration);
      const std::int64_t now_ns = clock::MonotonicNs();
      scene::Show::Shot shot = show.At(now_ns, false, {options.forces, options.overlay_reference});
      if (now_ns >= until_ns || background.stop_asked()) return shot;
      clock::SleepUntil(std::min(until_ns, now_ns + SecondsToNanoseconds(kStepS)));
    }
  }

  render::Image Draw(const scene::Show::Shot& shot) {
    target.Bind();
    render::HudOptions hud;
    hud.hidden = options.subject;
    hud.panels = options.look.panels;
    hud.camera = options.camera.corner;
    hud.camera_alone = options.camera.alone;
    screen.Draw(
        {shot.picture, show.model(), shot.frame, clock::MonotonicNs(), shot.past, shot.past_ns},
        hud, target.width(), target.height());
    return target.Read();
  }

  /// Until the first tick, or until the time is over without one.
  std::int64_t WaitForData() {
    const std::int64_t given_up_ns = started_ns + SecondsToNanoseconds(AtS());
    while (scene::IsWaiting(show.model()) && clock::MonotonicNs() < given_up_ns &&
           !background.stop_asked()) {
      FollowUntil(clock::MonotonicNs() + SecondsToNanoseconds(kStepS));
    }
    return scene::IsWaiting(show.model()) ? started_ns : clock::MonotonicNs();
  }
};

Result<void> TakeScreenshot(Studio& studio) {
  if (studio.AtS() >= kAnnouncedS) {
    log::Info("drawing " + studio.options.screenshot + " in " + text::Fixed(studio.AtS(), 0) +
              " s");
  }
  const std::int64_t from_ns = studio.WaitForData();
  if (scene::IsWaiting(studio.show.model()) && !studio.options.camera.alone) {
    std::string why = "no server has sent anything yet";
    for (const scene::LinkReport& link : studio.show.model().links) {
      if (!link.why.empty()) why += "; " + link.why;
    }
    log::Warning(why + transport::RemedyFor(why, "start footing-sim, or name it with --connect"));
  }
  const auto shot = studio.FollowUntil(from_ns + SecondsToNanoseconds(studio.AtS()));
  const auto written = render::WritePicture(studio.Draw(shot), studio.options.screenshot);
  if (written) log::Info("wrote " + studio.options.screenshot);
  return written;
}

Result<void> Record(Studio& studio) {
  const Options& options = studio.options;
  auto sink = PictureSink::Open(options.record, options.record_hz);
  if (!sink) return sink.error();
  const double seconds = options.seconds > 0 ? options.seconds : kRecordS;
  const auto count = static_cast<int>(seconds * options.record_hz);
  int late = 0;
  for (int i = 0; i < count && !studio.background.stop_asked(); ++i) {
    const std::int64_t due_ns =
        studio.started_ns + SecondsToNanoseconds((i + 1) / options.record_hz);
    if (clock::MonotonicNs() > due_ns + SecondsToNanoseconds(1 / options.record_hz)) ++late;
    const auto written = sink->Add(studio.Draw(studio.FollowUntil(due_ns)));
    if (!written) return written;
  }
  if (const auto finished = sink->Finish(); !finished) return finished;
  log::Info((IsFilm(options.record) ? "wrote " : "wrote pictures to ") + options.record);
  if (late > 0) {
    log::Warning(std::to_string(late) + " of " + std::to_string(count) +
                 " pictures are late: this machine needs a lower --record-hz");
  }
  return {};
}

}  // namespace

Result<void> RunOffScreen(const Options& options) {
  auto context = render::OffScreen::Create();
  if (!context) return context.error();
  auto target = render::Target::Create(options.width, options.height, options.samples);
  if (!target) return target.error();
  auto screen = render::Screen::Create();
  if (!screen) return screen.error();
  (*screen)->set_ui_scale(static_cast<float>(options.look.ui_scale));
  auto calibration = PoseCalibration::OfOptions(options.camera.calibration_file);
  if (!calibration) return calibration.error();
  Background background(options);
  Studio studio{options, *target, **screen, background, *calibration ? &**calibration : nullptr};
  if (options.replay_falls) studio.show.ReplayFalls();
  auto done = options.screenshot.empty() ? Record(studio) : TakeScreenshot(studio);
  if (done && options.json) {
    std::cout << Summary(studio.show.model(), studio.PassedS()) << std::endl;
  }
  return done;
}

}  // namespace footing::view
