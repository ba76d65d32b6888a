#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "tests/clients/view/made_stream.h"
#include "tests/clients/view/picture_fixture.h"

// Pictures of the made stream, judged by facts and not by bytes: drivers differ in every pixel.
namespace footing::render {
namespace {

bool IsSky(int r, int g, int b) { return b > 150 && b > g && g > r; }
bool PictureIsGrass(int r, int g, int b) { return g > r + 12 && g > b + 25; }
bool IsClay(int r, int g, int b) { return r > g + 30 && r > b + 30; }
bool IsFeather(int r, int g, int b) { return b > r + 40 && b > 60 && g > r; }

double MeanDifference(const Image& a, const Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) sum += std::abs(a.rgb[i] - b.rgb[i]);
  return sum / static_cast<double>(a.rgb.size());
}

class PictureTest : public PictureFixture {
 protected:
  /// The picture of a model at a time of the made stream, after its camera has settled.
  Image Draw(const scene::Model& model, double time_s, const scene::made::Wish& wish,
             const HudOptions& hud, const std::string& name) {
    Follow(model, time_s, wish);
    return Show(picture_, model, frame_, scene::made::ClockAt(time_s), hud, name);
  }
  void Follow(const scene::Model& model, double time_s, const scene::made::Wish& wish) {
    scene::Stage stage;
    frame_ = {};
    picture_ = stage.Advance(model, frame_, 0, 0, {});
    if (model.playout.empty()) return;
    for (int i = 50; i >= 0; --i) {
      frame_ = scene::made::TickAt(time_s - 0.01 * i, wish).frame.value();
      picture_ = stage.Advance(model, frame_, scene::made::ClockAt(time_s - 0.01 * i), 0.01, {});
    }
  }

  scene::WorldFrame frame_;
  scene::Picture picture_;
};

TEST_F(PictureTest, SkyIsAboveGrassAndTrackAndTheBirdIsBetween) {
  const scene::made::Wish wish;
  HudOptions subject;
  subject.hidden = true;
  const Image image = Draw(scene::made::ModelAfter(3, wish), 3, wish, subject, "subject");
  EXPECT_GT(ShareOf(image, IsSky, {0, 1, 0, 0.2}), 0.5);
  EXPECT_LT(ShareOf(image, IsSky, {0, 1, 0.6, 1}), 0.02);
  EXPECT_GT(ShareOf(image, PictureIsGrass, {0, 1, 0.5, 1}), 0.15);
  EXPECT_GT(ShareOf(image, IsClay, {0, 1, 0.5, 1}), 0.25);
  EXPECT_GT(ShareOf(image, IsFeather, {0, 1, 0.4, 0.9}), 0.01);
}

TEST_F(PictureTest, TheWholeBirdStandsInTheMiddleOfThePicture) {
  const scene::made::Wish wish;
  Follow(scene::made::ModelAfter(3, wish), 3, wish);
  target_->Bind();
  screen_->world().DrawIds(picture_, kWidth, kHeight);
  const Image ids = target_->Read();
  int left = kWidth, right = -1, top = kHeight, bottom = -1, pixels = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto i = static_cast<std::size_t>(3 * (y * kWidth + x));
      if (ids.rgb[i] != static_cast<std::uint8_t>(scene::PartId::kBird)) continue;
      left = std::min(left, x), right = std::max(right, x);
      top = std::min(top, y), bottom = std::max(bottom, y);
      ++pixels;
    }
  }
  ASSERT_GT(pixels, 0);
  // A bird 1.8 m high, 4.7 m away, in a picture that shows 2 tan(0.4) = 0.85 of its distance: near
  // 0.45 of the height.
  EXPECT_NEAR(static_cast<double>(bottom - top) / kHeight, 0.45, 0.10);
  EXPECT_GT(top, 0);
  EXPECT_LT(bottom, kHeight - 1);
  EXPECT_NEAR((left + right) / 2.0, kWidth / 2.0, 0.1 * kWidth);
  EXPECT_GT(pixels, 0.008 * kWidth * kHeight);
}

TEST_F(PictureTest, PanelsCoverOnlyTheirColumns) {
  const scene::made::Wish wish;
  const scene::Model model = scene::made::ModelAfter(3, wish);
  HudOptions subject;
  subject.hidden = true;
  const Image with = Draw(model, 3, wish, {}, "panels");
  const Image without = Draw(model, 3, wish, subject, "no_panels");
  EXPECT_GT(MeanDifference(with, without), 5);
  int changed = 0;
  for (int y = kHeight / 3; y < kHeight; ++y) {
    for (int x = kWidth * 3 / 10; x < kWidth * 7 / 10; ++x) {
      const auto i = static_cast<std::size_t>(3 * (y * kWidth + x));
      if (std::abs(with.rgb[i] - without.rgb[i]) > 2) ++changed;
    }
  }
  EXPECT_EQ(changed, 0);
}

TEST_F(PictureTest, TheStampOfSimulatedInputShowsInSubjectModeToo) {
  scene::made::Wish wish;
  HudOptions subject;
  subject.hidden = true;
  const auto amber = [](int r, int g, int b) { return r > 230 && g > 160 && g < 200 && b < 90; };
  const Image stamped = Draw(scene::made::ModelAfter(3, wish), 3, wish, subject, "stamped");
  EXPECT_GT(ShareOf(stamped, amber, {0, 1, 0, 0.08}), 0.03);
  wish.simulated = false;
  const Image real = Draw(scene::made::ModelAfter(3, wish), 3, wish, subject, "real");
  EXPECT_EQ(ShareOf(real, amber, {0, 1, 0, 0.08}), 0);
}

TEST_F(PictureTest, BeforeAnyServerTheGroundAndAWaitingPanelAreThere) {
  scene::Model model;
  model.links = {{"unix:/tmp/simulation.sock", "", scene::LinkState::kConnecting, ""}};
  const Image waiting = Draw(model, 0, {}, {}, "waiting");
  HudOptions subject;
  subject.hidden = true;
  const Image bare = Draw(model, 0, {}, subject, "empty_ground");
  EXPECT_GT(ShareOf(bare, PictureIsGrass, {0, 1, 0.6, 1}), 0.6);
  const auto letters = [](int r, int g, int b) { return r > 140 && g > 140 && b > 140; };
  EXPECT_GT(ShareOf(waiting, letters, {0, 1, 0.36, 0.52}),
            ShareOf(bare, letters, {0, 1, 0.36, 0.52}) + 0.002);
  EXPECT_GT(MeanDifference(waiting, bare), 3);
}

TEST_F(PictureTest, TheSameMomentGivesTheSamePicture) {
  const scene::made::Wish wish;
  const scene::Model model = scene::made::ModelAfter(3, wish);
  EXPECT_EQ(Draw(model, 3, wish, {}, "once").rgb, Draw(model, 3, wish, {}, "twice").rgb);
}

TEST_F(PictureTest, NoDarkPixelShowsBetweenThePiecesOfABend) {
  scene::Model model;
  model.track = scene::made::StraightTrack(1.7);
  for (int i = 0; i < 14; ++i) {
    stream::TrackSegment next = model.track.segments.back();
    next.start_m +=
        next.length_m * Eigen::Vector3d(std::cos(next.heading_rad), std::sin(next.heading_rad), 0);
    next.heading_rad += 0.11;
    model.track.segments.push_back(next);
  }
  model.track_version = 77;
  HudOptions subject;
  subject.hidden = true;
  const Image image = Draw(model, 0, {}, subject, "bend");
  EXPECT_GT(ShareOf(image, IsClay, {0, 1, 0.5, 1}), 0.25);
  const auto dark = [](int r, int g, int b) { return r + g + b < 150; };
  EXPECT_EQ(ShareOf(image, dark, {0, 1, 0.55, 1}), 0);
}

TEST_F(PictureTest, LimbsMeetWithoutSpots) {
  scene::Picture picture;
  picture.camera.eye_m = {0, 2.5, 0.9};
  picture.camera.target_m = {0, 0, 1};
  const scene::Colour white(0.8f, 0.8f, 0.8f);
  for (int i = 0; i < 6; ++i) {
    const float x = -0.6f + 0.2f * static_cast<float>(i);
    picture.figures.AddLimb({x, 0, 1}, {x + 0.2f, 0, 1}, 0.12f, 0.12f, white);
  }
  HudOptions subject;
  subject.hidden = true;
  const Image image = Show(picture, {}, {}, 0, subject, "limbs");
  // Along the middle row all is of one brightness; a cap inside a joint is much darker.
  int low = 255, high = 0;
  for (int y = kHeight / 2 - 20; y <= kHeight / 2 + 20; y += 1) {
    int row_low = 255, row_high = 0;
    for (int x = kWidth * 4 / 10; x < kWidth * 6 / 10; ++x) {
      const int red = image.rgb[static_cast<std::size_t>(3 * (y * kWidth + x))];
      row_low = std::min(row_low, red), row_high = std::max(row_high, red);
    }
    low = std::min(low, row_low - row_high), high = std::max(high, row_high - row_low);
  }
  EXPECT_LT(high, 14);
  EXPECT_GT(low, -14);
}

TEST_F(PictureTest, TheListOfKeysLeavesTheBirdInSight) {
  const scene::made::Wish wish;
  const scene::Model model = scene::made::ModelAfter(3, wish);
  HudOptions keys;
  keys.keys = true;
  const Image with = Draw(model, 3, wish, keys, "keys");
  const Image without = Draw(model, 3, wish, {}, "no_keys");
  EXPECT_GT(MeanDifference(with, without), 1);
  int changed = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = kWidth * 4 / 10; x < kWidth * 6 / 10; ++x) {
      const auto i = static_cast<std::size_t>(3 * (y * kWidth + x));
      if (std::abs(with.rgb[i] - without.rgb[i]) > 2) ++changed;
    }
  }
  EXPECT_EQ(changed, 0);
}

TEST_F(PictureTest, EdgesAreSmoothUnlessAskedOtherwise) {
  const auto smooth = Target::Create(64, 64, std::nullopt);
  ASSERT_TRUE(smooth) << smooth.error().message;
  EXPECT_EQ(smooth->samples(), Target::kSamples) << "Mesa has them";
}

TEST(Target, RefusesSizesThatNoPictureHas) {
  EXPECT_EQ(Target::Create(0, 10, 0).error().kind, ErrorKind::kUsage);
  EXPECT_EQ(Target::Create(10, 100'000, 0).error().kind, ErrorKind::kUsage);
}

TEST(WritePng, NamesTheFileThatItCannotWrite) {
  const auto written = WritePng({1, 1, {0, 0, 0}}, "/nowhere/picture.png");
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("/nowhere/picture.png"), std::string::npos);
}

}  // namespace
}  // namespace footing::render
