#include <gtest/gtest.h>

#include <cstdlib>

#include "clients/view/render/off_screen.h"
#include "clients/view/render/screen.h"
#include "clients/view/render/target.h"
#include "clients/view/scene/stage.h"
#include "tests/clients/view/made_stream.h"

namespace footing::render {
namespace {

TEST(Picture, Try) {
  auto context = OffScreen::Create();
  ASSERT_TRUE(context) << context.error().message;
  auto target = Target::Create(getenv("BIG") ? 2560 : 1280, getenv("BIG") ? 1440 : 720, 4);
  ASSERT_TRUE(target);
  auto screen = Screen::Create(getenv("BIG") ? 2 : 1);
  ASSERT_TRUE(screen) << screen.error().message;
  const char* gait = std::getenv("T");
  const double t = gait ? atof(gait) : 6.13;
  scene::made::Wish wish;
  scene::Model model = scene::made::ModelAfter(t, wish);
  scene::Stage stage;
  scene::Picture picture;
  scene::WorldFrame frame;
  for (int i = 100; i >= 0; --i) {
    frame = scene::made::TickAt(t - 0.01 * i, wish).frame.value();
    picture = stage.Advance(model, frame, 0.01, {getenv("FORCES") != nullptr});
  }
  target->Bind();
  HudOptions options;
  options.hidden = getenv("SUBJECT") != nullptr;
  (*screen)->Draw(picture, model, frame, scene::made::ClockAt(t), options,
                  getenv("BIG") ? 2560 : 1280, getenv("BIG") ? 1440 : 720);
  ASSERT_TRUE(WritePng(target->Read(), "/tmp/view/try.png"));
}

}  // namespace
}  // namespace footing::render
