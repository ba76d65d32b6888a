#include <gtest/gtest.h>

#include <algorithm>

#include "tests/clients/view/made_stream.h"
#include "tests/clients/view/picture_fixture.h"

// The panel of strips, as it is drawn.
namespace footing::render {
namespace {

class StripPictureTest : public PictureFixture {
 protected:
  void TearDown() override { Resize(kWidth, kHeight); }
};

TEST_F(StripPictureTest, TheTitleOfAnAccelerationHidesNoneOfIt) {
  const scene::made::Wish wish;
  const scene::Model model = scene::made::ModelAfter(12, wish);
  scene::Stage stage;
  const std::int64_t now_ns = scene::made::ClockAt(12);
  const scene::WorldFrame frame = scene::made::TickAt(12, wish).frame.value();
  const scene::Picture picture = stage.Advance(model, frame, now_ns, 0.01, {});
  Resize(1280, 720);
  const Image image = Show(picture, model, frame, now_ns, {}, "strips");
  const HudBoxes boxes =
      BoxesOf({picture, model, frame, now_ns, model, now_ns}, {}, {1280, 720}, 1);
  ASSERT_TRUE(boxes.strips);
  // The norm is white and swings all the time: its highest row, from the plot's left edge.
  const auto highest = [&](int from, int to) {
    const int left = static_cast<int>(boxes.strips->low.x) + 44;
    const int top = static_cast<int>(boxes.strips->low.y) + 37;
    for (int y = top; y < top + 50; ++y) {
      for (int x = left + from; x < left + to; ++x) {
        const auto i = static_cast<std::size_t>(3 * (y * image.width + x));
        if (std::min({image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]}) > 225) return y - top;
      }
    }
    return 50;
  };
  const int under_the_title = highest(4, 70), beside_the_title = highest(150, 180);
  EXPECT_LT(beside_the_title, 50);
  EXPECT_NEAR(under_the_title, beside_the_title, 2);
}

TEST_F(StripPictureTest, StripsHaveLabelsBesideAndUnderThem) {
  const scene::made::Wish wish;
  const scene::Model model = scene::made::ModelAfter(12, wish);
  const scene::WorldFrame frame = scene::made::TickAt(12, wish).frame.value();
  scene::Stage stage;
  const std::int64_t now_ns = scene::made::ClockAt(12);
  const scene::Picture picture = stage.Advance(model, frame, now_ns, 0.01, {});
  const Image image = Show(picture, model, frame, now_ns, {}, "axes");
  const HudBoxes boxes =
      BoxesOf({picture, model, frame, now_ns, model, now_ns}, {}, {kWidth, kHeight}, 1);
  ASSERT_TRUE(boxes.strips);
  const Box& strips = *boxes.strips;
  const auto letters = [](int r, int g, int b) { return r > 120 && g > 120 && b > 120; };
  const auto share = [&](float left, float right, float top, float bottom) {
    return ShareOf(image, letters,
                   {left / kWidth, right / kWidth, top / kHeight, bottom / kHeight});
  };
  // Left of the curves, 14 units of margin and 30 of labels; the seconds in the lowest row.
  EXPECT_GT(share(strips.low.x + 14, strips.low.x + 42, strips.low.y + 40, strips.high.y - 30),
            0.01);
  EXPECT_GT(share(strips.low.x + 44, strips.high.x - 14, strips.high.y - 26, strips.high.y - 13),
            0.01);
}

}  // namespace
}  // namespace footing::render
