#include "clients/view/app/view_mouse.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"
#include "tests/clients/view/made_stream.h"

namespace footing::view {
namespace {

using Button = ViewMouse::Button;

/// A window of 1280 x 720 with the made character in it and its strips at the left.
class ViewMouseTest : public ::testing::Test {
 protected:
  void SetUp() override { mouse_.SetViews({view_}, true); }

  static DrawnView View() {
    const scene::made::Wish wish;
    const scene::Model model = scene::made::ModelAfter(12, wish);
    scene::Stage stage;
    DrawnView view;
    view.world = {{0, 0}, {1280, 720}};
    view.strips = render::Box{{18, 300}, {318, 700}};
    view.frame = scene::made::TickAt(12, wish).frame.value();
    view.camera = stage.Advance(model, view.frame, scene::made::ClockAt(12), 0.01, {}).camera;
    return view;
  }
  /// Pixels of a point of the world.
  ImVec2 PixelOf(const Eigen::Vector3d& p_m) const {
    const Eigen::Vector4f clip = view_.camera.Projection(16.0 / 9) * view_.camera.View() *
                                 p_m.cast<float>().eval().homogeneous();
    return {640 * (1 + clip.x() / clip.w()), 360 * (1 - clip.y() / clip.w())};
  }
  ImVec2 Body() const { return PixelOf(view_.frame.characters[0].com_m); }

  void Drag(Button button, ImVec2 from, ImVec2 by, double time_s) {
    mouse_.Move(from);
    mouse_.Press(button, time_s);
    mouse_.Move({from.x + by.x, from.y + by.y});
  }

  DrawnView view_ = View();
  ViewMouse mouse_;
};

TEST_F(ViewMouseTest, ADragBesideTheCharacterTurnsAndTheOtherButtonShifts) {
  mouse_.Move({1000, 100});
  EXPECT_EQ(mouse_.orbit().azimuth_rad, 0) << "without a press nothing turns";
  Drag(Button::kLeft, {1000, 100}, {72, 36}, 1);
  EXPECT_FALSE(mouse_.Release());
  // A drag over the picture's height turns by half a turn.
  EXPECT_NEAR(mouse_.orbit().azimuth_rad, -0.1 * kPi, 1e-6);
  EXPECT_NEAR(mouse_.orbit().elevation_rad, 0.05 * kPi, 1e-6);
  Drag(Button::kOther, {1000, 100}, {72, 36}, 5);
  EXPECT_FALSE(mouse_.Release());
  EXPECT_NEAR(mouse_.orbit().shift.x(), 0.1, 1e-6);
  EXPECT_NEAR(mouse_.orbit().shift.y(), 0.05, 1e-6);
  mouse_.Move({0, 0});
  EXPECT_NEAR(mouse_.orbit().shift.x(), 0.1, 1e-6);
}

TEST_F(ViewMouseTest, ADragOnTheCharacterPushesItAndTurnsNothing) {
  Drag(Button::kLeft, Body(), {0, -72}, 1);
  const auto shown = mouse_.push();
  ASSERT_TRUE(shown);
  const auto pushed = mouse_.Release();
  ASSERT_TRUE(pushed);
  EXPECT_EQ(pushed->character, view_.frame.characters[0].character);
  EXPECT_EQ(pushed->impulse_W_ns, shown->impulse_W_ns);
  // The camera is behind it: upwards is ahead.
  EXPECT_GT(pushed->impulse_W_ns.x(), 0.9 * pushed->impulse_W_ns.norm());
  EXPECT_EQ(mouse_.orbit().azimuth_rad, 0);
  EXPECT_FALSE(mouse_.push());
}

TEST_F(ViewMouseTest, APushThatIsCancelledOrOnlyAClickIsNotSent) {
  Drag(Button::kLeft, Body(), {0, -72}, 1);
  EXPECT_TRUE(mouse_.Cancel());
  EXPECT_FALSE(mouse_.Release());
  EXPECT_FALSE(mouse_.Cancel());
  Drag(Button::kLeft, Body(), {0, 0}, 5);
  EXPECT_FALSE(mouse_.Release());
}

TEST_F(ViewMouseTest, WhereNobodyMayPushADragOnTheCharacterTurns) {
  mouse_.SetViews({view_}, false);
  Drag(Button::kLeft, Body(), {72, 0}, 1);
  EXPECT_FALSE(mouse_.push());
  EXPECT_FALSE(mouse_.Release());
  EXPECT_NEAR(mouse_.orbit().azimuth_rad, -0.1 * kPi, 1e-6);
}

TEST_F(ViewMouseTest, ADoubleClickFollowsTheCharacterOrResetsTheView) {
  const auto double_click = [this](ImVec2 at, double time_s) {
    Drag(Button::kLeft, at, {0, 0}, time_s);
    mouse_.Release();
    Drag(Button::kLeft, at, {0, 0}, time_s + 0.2);
    EXPECT_FALSE(mouse_.Release());
  };
  Drag(Button::kLeft, {1000, 100}, {72, 0}, 1);
  mouse_.Release();
  double_click(Body(), 3);
  EXPECT_EQ(mouse_.followed(), view_.frame.characters[0].character);
  EXPECT_EQ(mouse_.orbit().azimuth_rad, 0);
  Drag(Button::kLeft, {1000, 100}, {72, 0}, 5);
  mouse_.Release();
  double_click({1000, 100}, 8);
  EXPECT_EQ(mouse_.orbit().azimuth_rad, 0);
  EXPECT_EQ(mouse_.followed(), view_.frame.characters[0].character) << "the view alone is reset";
  // Two presses far apart in time or place are two drags.
  Drag(Button::kLeft, {1000, 100}, {72, 0}, 12);
  mouse_.Release();
  Drag(Button::kLeft, {1100, 100}, {0, 0}, 12.1);
  mouse_.Release();
  EXPECT_NE(mouse_.orbit().azimuth_rad, 0);
}

TEST_F(ViewMouseTest, TheWheelZoomsTheStripsOverThemAndTheViewElsewhere) {
  mouse_.Move({200, 500});
  mouse_.Scroll(3);
  EXPECT_LT(mouse_.window().span_s, 6);
  EXPECT_EQ(mouse_.orbit().distance, 1);
  const double age_s = mouse_.window().age_s;
  Drag(Button::kLeft, {200, 500}, {30, 0}, 1);
  mouse_.Release();
  EXPECT_GT(mouse_.window().age_s, age_s);
  EXPECT_EQ(mouse_.orbit().azimuth_rad, 0);
  Drag(Button::kLeft, {230, 500}, {0, 0}, 5);
  mouse_.Release();
  Drag(Button::kLeft, {230, 500}, {0, 0}, 5.1);
  EXPECT_EQ(mouse_.window().span_s, scene::TimeWindow::kLongestS);
  mouse_.Move({900, 200});
  mouse_.Scroll(3);
  EXPECT_LT(mouse_.orbit().distance, 1);
  EXPECT_EQ(mouse_.window().span_s, scene::TimeWindow::kLongestS);
}

TEST_F(ViewMouseTest, BeforeTheFirstPictureNothingHappens) {
  ViewMouse mouse;
  mouse.Move({5, 5});
  mouse.Press(Button::kLeft, 1);
  mouse.Scroll(1);
  EXPECT_FALSE(mouse.push());
  EXPECT_FALSE(mouse.Release());
}

}  // namespace
}  // namespace footing::view
