#include "clients/view/app/play_pictures.h"

#include <list>
#include <string>
#include <vector>

#include "clients/view/app/pictures.h"
#include "clients/view/render/off_screen.h"
#include "clients/view/render/play_picture.h"
#include "clients/view/render/target.h"
#include "clients/view/scene/timeline_text.h"
#include "common/runtime/log.h"

namespace footing::view {
namespace {

/// What goes on at the head, for the timeline.
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
  picture.timeline = options.look.timeline && !options.subject;
  return picture;
}

void DrawSession(render::Screen& screen, PlaySession& session, const PlayPicture& picture,
                 int width, int height) {
  const scene::StageOptions stage{picture.hud.forces, picture.hud.overlay_reference};
  const bool compared = session.sides().size() > 1;
  std::list<scene::Show::Shot> shots;
  std::vector<render::PlayedView> views;
  render::TimelineContent line{session.timeline(), {}, session.head(), TrialTextOf(session)};
  for (PlayedSide& side : session.sides()) {
    scene::Show::Shot& shot = shots.emplace_back(session.ShotOf(side, stage));
    shot.picture.camera = scene::Orbited(shot.picture.camera, picture.orbit);
    const std::int64_t now_ns = session.ClockOf(side);
    views.push_back({{shot.picture, side.show.model(), shot.frame, now_ns, shot.past, shot.past_ns},
                     compared && !picture.hud.hidden ? side.name : "",
                     compared ? timeline::StateText(session.StateOf(side)) : ""});
    line.lanes.push_back(&side.timeline);
  }
  render::DrawPlayback(screen, views, picture.hud, picture.timeline ? &line : nullptr, width,
                       height);
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
  log::Info("wrote " + std::to_string(count) + " pictures to " + options.record);
  return {};
}

}  // namespace footing::view
