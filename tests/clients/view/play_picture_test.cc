#include "clients/view/render/screen.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "tests/clients/view/made_stream.h"
#include "tests/clients/view/picture_fixture.h"

// Playback as it is drawn: one recording, two side by side, the timeline.
namespace footing::render {
namespace {

using stream::FailureCause;

timeline::Timeline SampleLine() {
  timeline::Timeline line;
  line.begin_s = -2;
  line.end_s = 38;
  timeline::TrialMark trial;
  trial.id = "p07-1";
  trial.begin_s = -2;
  trial.start_s = 0;
  trial.end_s = 36;
  line.trials.push_back(trial);
  double at_s = 4;
  for (const FailureCause cause : stream::kFailureCauses) {
    timeline::FailureMark mark;
    mark.at_s = at_s += 5;
    mark.cause = cause;
    line.failures.push_back(mark);
  }
  return line;
}

class PlayPictureTest : public PictureFixture {
 protected:
  static void SetUpTestSuite() {
    PictureFixture::SetUpTestSuite();
    if (screen_) {
      ASSERT_TRUE(screen_->AddWorld());
    }
  }
  void TearDown() override { Resize(kWidth, kHeight); }

  PlayedView View() const { return {{picture_, model_, frame_, now_ns_, model_, now_ns_}, "", ""}; }

  static Image Played(const std::vector<PlayedView>& views, const HudOptions& options,
                      const TimelineContent* line, const std::string& name) {
    target_->Bind();
    DrawPlayback(*screen_, views, options, line, target_->width(), target_->height());
    Image image = target_->Read();
    if (const char* folder = std::getenv("FOOTING_PICTURES")) {
      EXPECT_TRUE(WritePng(image, std::string(folder) + "/" + name + ".png"));
    }
    return image;
  }

  scene::made::Wish wish_;
  scene::Model model_ = scene::made::ModelAfter(12, wish_);
  scene::WorldFrame frame_ = scene::made::TickAt(12, wish_).frame.value();
  std::int64_t now_ns_ = scene::made::ClockAt(12);
  scene::Stage stage_;
  scene::Picture picture_ = stage_.Advance(model_, frame_, now_ns_, 0.01, {});
};

std::array<int, 3> PixelAt(const Image& image, float x, float y) {
  const auto i =
      static_cast<std::size_t>(3 * (static_cast<int>(y) * image.width + static_cast<int>(x)));
  return {image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]};
}

std::array<int, 3> BytesOf(ImU32 colour) {
  return {static_cast<int>(colour >> IM_COL32_R_SHIFT & 0xff),
          static_cast<int>(colour >> IM_COL32_G_SHIFT & 0xff),
          static_cast<int>(colour >> IM_COL32_B_SHIFT & 0xff)};
}

TEST_F(PlayPictureTest, WithoutTheTimelineItIsThePictureOfALiveView) {
  for (const bool subject : {false, true}) {
    HudOptions options;
    options.hidden = subject;
    const Image live = Show(picture_, model_, frame_, now_ns_, options, "live");
    const Image played = Played({View()}, options, nullptr, "played");
    EXPECT_EQ(live.rgb, played.rgb) << subject;
  }
}

TEST_F(PlayPictureTest, EveryFailureStandsInTheTimelineInItsColour) {
  for (const auto& [width, height] : {std::pair{640, 400}, {1280, 720}, {2560, 1440}}) {
    Resize(width, height);
    const timeline::Timeline line = SampleLine();
    timeline::PlayHead head = timeline::HeadAt(line.begin_s, line.end_s, 1);
    const TimelineContent content{line, {&line}, head, "trial p07-1"};
    const Image image = Played({View()}, {}, &content, "timeline_" + std::to_string(width));
    const TimelineBoxes boxes = TimelineBoxesOf(*screen_, width, height, 1);
    const float middle = (boxes.groove.low.y + boxes.groove.high.y) / 2;
    for (const timeline::FailureMark& mark : line.failures) {
      const float x = ColumnOf(boxes.groove, line, mark.at_s);
      EXPECT_EQ(PixelAt(image, x, middle), BytesOf(ColourOf(mark.cause)))
          << width << " " << stream::Name(mark.cause);
    }
    // Nothing of the picture before shines through.
    EXPECT_EQ(Played({View()}, {}, &content, "again").rgb, image.rgb);
  }
}

TEST_F(PlayPictureTest, AnEventIsMarkedAndTheMouseOverItSaysWhatItIs) {
  timeline::Timeline line = SampleLine();
  line.events = {{2, "T-pose taken: 71.2 kg"}};
  const TimelineContent content{line, {&line}, timeline::HeadAt(-2, 38, 1), ""};
  HudOptions options;
  const Image without = Played({View()}, options, &content, "event");
  const TimelineBoxes boxes = TimelineBoxesOf(*screen_, kWidth, kHeight, 1);
  const float x = ColumnOf(boxes.groove, line, 2);
  const float middle = (boxes.groove.low.y + boxes.groove.high.y) / 2;
  const auto [red, green, blue] = PixelAt(without, x, middle);
  EXPECT_GT(red, 180);
  EXPECT_GT(green, 180);
  EXPECT_LT(blue, 180);
  options.pointer = ImVec2(x + 2, middle);
  const Image with = Played({View()}, options, &content, "event_pointed");
  const auto letters = [](int r, int g, int b) { return std::min({r, g, b}) > 200; };
  const double top = static_cast<double>(boxes.bar.low.y) - 24, share = 0.1;
  const Region over{std::max(0.0, x / kWidth - share), x / kWidth + share, top / kHeight,
                    (top + 20) / kHeight};
  EXPECT_GT(ShareOf(with, letters, over), ShareOf(without, letters, over) + 0.012);
}

TEST_F(PlayPictureTest, PositionsAndColumnsOfTheTimelineAgree) {
  const timeline::Timeline line = SampleLine();
  const Box groove = LayOutTimeline({1280, 720}, 1, 1).groove;
  for (const double at_s : {-2.0, 0.0, 17.25, 38.0}) {
    EXPECT_NEAR(PositionAt(groove, line, ColumnOf(groove, line, at_s)), at_s, 1e-3);
  }
  EXPECT_EQ(PositionAt(groove, line, -100), -2);
  EXPECT_EQ(PositionAt(groove, line, 1e6f), 38);
  EXPECT_EQ(ColumnOf(groove, timeline::Timeline{}, 5), groove.low.x);
}

TEST_F(PlayPictureTest, SideBySideEachHalfIsThePictureOfItsOwn) {
  HudOptions options;
  options.columns = false;
  const Image both = Played({View(), View()}, options, nullptr, "beside");
  Resize(kWidth / 2, kHeight);
  // The panels keep the size that the whole window asks for; the world alone is compared.
  const Image half = Played({View()}, options, nullptr, "half");
  int different = 0;
  for (int y = kHeight / 2; y < kHeight; ++y) {
    for (int x = 0; x < kWidth / 2; ++x) {
      for (const int left : {0, kWidth / 2}) {
        // The line between both is one pixel wide on each side.
        if (x < 2 || x >= kWidth / 2 - 2) continue;
        different += PixelAt(both, static_cast<float>(left + x), static_cast<float>(y)) !=
                     PixelAt(half, static_cast<float>(x), static_cast<float>(y));
      }
    }
  }
  EXPECT_LT(different, kWidth * kHeight / 1000);
}

TEST_F(PlayPictureTest, TheKeysOfPlaybackAreListedAtEverySize) {
  for (const auto& [width, height] : {std::pair{640, 400}, {1280, 720}, {2560, 1440}}) {
    Resize(width, height);
    HudOptions options;
    options.keys = true;
    const Image keys = Played({View()}, options, nullptr, "keys_" + std::to_string(width));
    options.keys = false;
    const Image bare = Played({View()}, options, nullptr, "bare");
    // The whole list lies within the picture: its first and last rows of pixels are untouched.
    const auto row = static_cast<std::size_t>(3 * width);
    EXPECT_TRUE(std::equal(keys.rgb.begin(), keys.rgb.begin() + static_cast<std::ptrdiff_t>(row),
                           bare.rgb.begin()));
    EXPECT_TRUE(std::equal(keys.rgb.end() - static_cast<std::ptrdiff_t>(row), keys.rgb.end(),
                           bare.rgb.end() - static_cast<std::ptrdiff_t>(row)));
    EXPECT_NE(keys.rgb, bare.rgb);
  }
}

}  // namespace
}  // namespace footing::render
