#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>

#include "clients/view/render/off_screen.h"
#include "clients/view/render/screen.h"
#include "clients/view/render/target.h"
#include "clients/view/scene/stage.h"
#include "tests/clients/view/made_person.h"
#include "tests/clients/view/made_stream.h"

// Mesa's software driver keeps some memory to its end in modules that are unloaded by then: under
// AddressSanitizer leaks are not looked for here.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() { return "detect_leaks=0"; }

// Pictures of the made person, judged by facts and not by bytes. FOOTING_PICTURES=FOLDER keeps them
// as PNG files, to look at.
namespace footing::render {
namespace {

constexpr int kWidth = 1280;
constexpr int kHeight = 720;

using scene::made::PersonWish;
using Is = std::function<bool(int red, int green, int blue)>;

bool IsShirt(int r, int g, int b) { return b > r + 35 && g > r + 35 && std::abs(g - b) < 45; }
bool IsYellow(int r, int g, int b) { return r > b + 50 && g > b + 35 && r >= g; }
bool IsGrass(int r, int g, int b) { return g > r + 12 && g > b + 25; }

struct Region {
  double left = 0, right = 1, top = 0, bottom = 1;
};

/// The share of a part of the picture that is of a colour.
double ShareOf(const Image& image, const Is& is, const Region& region) {
  std::size_t count = 0, all = 0;
  for (int y = static_cast<int>(region.top * kHeight); y < region.bottom * kHeight; ++y) {
    for (int x = static_cast<int>(region.left * kWidth); x < region.right * kWidth; ++x) {
      const auto i = static_cast<std::size_t>(3 * (y * kWidth + x));
      ++all;
      if (is(image.rgb[i], image.rgb[i + 1], image.rgb[i + 2])) ++count;
    }
  }
  return static_cast<double>(count) / static_cast<double>(all);
}

class PersonPictureTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto context = OffScreen::Create();
    if (!context) {
      why_ = context.error().message;
      return;
    }
    context_ = std::make_unique<OffScreen>(std::move(*context));
    auto target = Target::Create(kWidth, kHeight, 0);
    auto screen = Screen::Create(1.0f);
    if (!target || !screen) {
      why_ = target ? screen.error().message : target.error().message;
      return;
    }
    target_ = std::make_unique<Target>(std::move(*target));
    screen_ = std::move(*screen);
  }
  static void TearDownTestSuite() {
    screen_.reset();
    target_.reset();
    context_.reset();
  }
  void SetUp() override { ASSERT_NE(screen_, nullptr) << why_; }

  Image Draw(const PersonWish& wish, const scene::StageOptions& options, const HudOptions& hud,
             const std::string& name) {
    constexpr double kTimeS = 2.2;
    const scene::Model model = scene::made::PersonModelAfter(kTimeS, wish);
    scene::Stage stage;
    scene::WorldFrame frame;
    scene::Picture picture;
    for (int i = 100; i >= 0; --i) {
      const double time_s = kTimeS - 0.01 * i;
      frame = scene::made::PersonTickAt(time_s, wish).frame.value();
      picture = stage.Advance(model, frame, scene::made::ClockAt(kTimeS), 0.01, options);
    }
    target_->Bind();
    screen_->Draw(picture, model, frame, scene::made::ClockAt(kTimeS), hud, kWidth, kHeight);
    Image image = target_->Read();
    if (const char* folder = std::getenv("FOOTING_PICTURES")) {
      EXPECT_TRUE(WritePng(image, std::string(folder) + "/" + name + ".png"));
    }
    return image;
  }
  static HudOptions Subject() {
    HudOptions hud;
    hud.hidden = true;
    return hud;
  }

  static std::string why_;
  static std::unique_ptr<OffScreen> context_;
  static std::unique_ptr<Target> target_;
  static std::unique_ptr<Screen> screen_;
};

std::string PersonPictureTest::why_;
std::unique_ptr<OffScreen> PersonPictureTest::context_;
std::unique_ptr<Target> PersonPictureTest::target_;
std::unique_ptr<Screen> PersonPictureTest::screen_;

constexpr Region kMiddle{0.3, 0.7, 0.1, 0.95};

TEST_F(PersonPictureTest, ADressedPersonStandsInAStudioAndNotOnGrass) {
  PersonWish wish;
  wish.reference = false;
  const Image image = Draw(wish, {}, Subject(), "person");
  EXPECT_GT(ShareOf(image, IsShirt, kMiddle), 0.01);
  EXPECT_LT(ShareOf(image, IsGrass, {0, 1, 0.6, 1}), 0.01);
}

TEST_F(PersonPictureTest, TheReferenceStandsBesideAndIsSeenThrough) {
  PersonWish wish;
  const Image with = Draw(wish, {}, Subject(), "reference_beside");
  EXPECT_GT(ShareOf(with, IsYellow, {0.12, 0.48, 0.2, 0.9}), 0.02);
  Draw(wish, {.overlay_reference = true}, Subject(), "reference_over");
}

TEST_F(PersonPictureTest, BeforeTheTPoseThereIsASilhouetteAndNoPerson) {
  PersonWish wish;
  wish.calibrated = false;
  wish.reference = false;
  const Image image = Draw(wish, {}, {}, "wizard");
  PersonWish taken;
  taken.reference = false;
  const Image person = Draw(taken, {}, {}, "panels");
  const auto skin = [](int r, int g, int b) { return r > g + 18 && g > b + 18 && r > 140; };
  EXPECT_LT(ShareOf(image, skin, {0.42, 0.58, 0.15, 0.4}), 0.005);
  EXPECT_GT(ShareOf(person, skin, {0.42, 0.58, 0.15, 0.5}), 0.01);
  const auto green = [](int r, int g, int b) { return g > r + 60 && g > b + 40; };
  EXPECT_GT(ShareOf(image, green, {0.3, 0.7, 0.8, 1}), 0.001) << "the ring";
}

TEST_F(PersonPictureTest, AFootThatIsOffItsBoardHasAWideEllipse) {
  PersonWish off;
  off.left_foot_off = true;
  off.reference = false;
  Draw(off, {}, {}, "foot_off");
  Draw({}, {}, {}, "panels_reference");
}

}  // namespace
}  // namespace footing::render
