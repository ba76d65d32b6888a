#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "tests/clients/view/made_person.h"
#include "tests/clients/view/made_stream.h"
#include "tests/clients/view/picture_fixture.h"

// Pictures of the made person, judged by facts and not by bytes.
namespace footing::render {
namespace {

using scene::made::PersonWish;

bool IsShirt(int r, int g, int b) { return b > r + 35 && g > r + 35 && std::abs(g - b) < 45; }
bool IsYellow(int r, int g, int b) { return r > b + 50 && g > b + 35 && r >= g; }
bool IsGrass(int r, int g, int b) { return g > r + 12 && g > b + 25; }

class PersonPictureTest : public PictureFixture {
 protected:
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
    return Show(picture, model, frame, scene::made::ClockAt(kTimeS), hud, name);
  }
  static HudOptions Subject() {
    HudOptions hud;
    hud.hidden = true;
    return hud;
  }
};

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
