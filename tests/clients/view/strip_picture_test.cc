#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

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

TEST_F(StripPictureTest, TheMouseOverTheStripsReadsTheirValuesThere) {
  const scene::made::Wish wish;
  const scene::Model model = scene::made::ModelAfter(12, wish);
  const scene::WorldFrame frame = scene::made::TickAt(12, wish).frame.value();
  scene::Stage stage;
  const std::int64_t now_ns = scene::made::ClockAt(12);
  const scene::Picture picture = stage.Advance(model, frame, now_ns, 0.01, {});
  HudOptions options;
  const HudBoxes boxes =
      BoxesOf({picture, model, frame, now_ns, model, now_ns}, options, {kWidth, kHeight}, 1);
  ASSERT_TRUE(boxes.strips);
  const Box& strips = *boxes.strips;
  const float column = strips.low.x + 0.6f * strips.width(), row = strips.low.y + 100;
  // Column and its neighbour in a row of pixels between two plots: the line alone is there.
  const auto is_line = [&](const Image& image, float x) {
    int bright = 0;
    for (int y = static_cast<int>(strips.low.y) + 40; y < static_cast<int>(strips.high.y) - 40;
         ++y) {
      const auto i = static_cast<std::size_t>(3 * (y * image.width + static_cast<int>(x)));
      bright += std::min({image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]}) > 150 ? 1 : 0;
    }
    return bright > 0.7f * (strips.height() - 80);
  };
  const Image without = Show(picture, model, frame, now_ns, options, "strips_plain");
  EXPECT_FALSE(is_line(without, column));
  options.pointer = ImVec2(column, row);
  const Image with = Show(picture, model, frame, now_ns, options, "strips_read");
  EXPECT_TRUE(is_line(with, column) || is_line(with, column - 1));
  // Zoomed in, the curves are other ones; the panels beside them are not.
  options.pointer.reset();
  options.window = scene::Zoomed({}, 8, 0.5);
  const Image zoomed = Show(picture, model, frame, now_ns, options, "strips_zoomed");
  EXPECT_NE(zoomed.rgb, without.rgb);
  const auto right_half = [](const Image& image) {
    std::vector<std::uint8_t> pixels;
    for (int y = 0; y < image.height; ++y) {
      const auto row_at = image.rgb.begin() + static_cast<std::ptrdiff_t>(3) * y * image.width;
      pixels.insert(pixels.end(), row_at + 3 * image.width / 2, row_at + 3 * image.width);
    }
    return pixels;
  };
  EXPECT_EQ(right_half(zoomed), right_half(without));
}

}  // namespace
}  // namespace footing::render
