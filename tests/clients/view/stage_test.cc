#include "clients/view/scene/stage.h"

#include <gtest/gtest.h>

#include "clients/view/scene/tally.h"
#include "tests/clients/view/made_stream.h"

namespace footing::scene {
namespace {

TEST(Stage, AnEmptyWorldHasAGroundAndNoBird) {
  Stage stage;
  const Picture picture = stage.Advance({}, {}, 0, 0.01, {});
  EXPECT_TRUE(picture.figures.balls.empty());
  EXPECT_EQ(picture.ground_m, 0);
  EXPECT_TRUE(picture.camera.View().allFinite());
}

TEST(Stage, ABirdHasAShadowUnderItsCentreOfMassAndUnderItsFeet) {
  const Model model = made::ModelAfter(1, {});
  Stage stage;
  const Picture picture = stage.Advance(model, model.playout.Newest(), 0, 0.01, {});
  ASSERT_EQ(picture.blobs.size(), 3u);
  EXPECT_NEAR(picture.blobs[0].position_m.x(), 2, 1e-5);  // 2 m/s for 1 s.
  EXPECT_EQ(picture.blobs[0].position_m.z(), 0);
  EXPECT_EQ(picture.footholds.size(), 1u);
}

TEST(Stage, ForceArrowsAreDrawnOnlyWhenAskedForAndOnlyAtTouchingFeet) {
  const Model model = made::ModelAfter(1, {});
  const WorldFrame& frame = model.playout.Newest();
  std::size_t touching = 0;
  for (const auto& contact : frame.characters[0].contacts) touching += contact.touching ? 1 : 0;
  Stage stage;
  EXPECT_TRUE(stage.Advance(model, frame, 0, 0.01, {false}).forces.rods.empty());
  EXPECT_EQ(stage.Advance(model, frame, 0, 0.01, {true}).forces.rods.size(), 2 * touching);
}

TEST(Stage, APoseWithoutLinksIsDrawnAsNothing) {
  WorldFrame frame;
  frame.characters.resize(1);
  frame.characters[0].valid = true;
  Stage stage;
  EXPECT_TRUE(stage.Advance({}, frame, 0, 0.01, {true}).figures.balls.empty());
}

TEST(Stage, ThePictureFollowsThePersonsHead) {
  const Model model = made::ModelAfter(1, {});
  WorldFrame frame = made::TickAt(1, {}).frame.value();
  frame.characters.front().interface.view_roll_rad = 0.3;
  Stage stage;
  Picture picture;
  for (int i = 0; i < 100; ++i) picture = stage.Advance(model, frame, 0, 0.02, {});
  EXPECT_NEAR(picture.camera.roll_rad, 0.3, 1e-3);
  frame.characters.front().interface.view_roll_rad = 0;
  for (int i = 0; i < 100; ++i) picture = stage.Advance(model, frame, 0, 0.02, {});
  EXPECT_NEAR(picture.camera.roll_rad, 0, 1e-3);
}

}  // namespace
}  // namespace footing::scene
