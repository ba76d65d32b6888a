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

CharacterPose Turned(double yaw_rad, bool touching) {
  CharacterPose pose = made::TickAt(0, {}).frame->characters[0];
  pose.links[0].orientation = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ());
  for (auto& contact : pose.contacts) contact.touching = touching;
  return pose;
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

TEST(BirdMotion, TheHeadFollowsATurnByAFilterOfAFifthOfASecond) {
  const BirdSkeleton skeleton = FindParts(made::Biped());
  BirdMotion motion = Advance({}, skeleton, Turned(0, true), 0);
  motion = Advance(motion, skeleton, Turned(1, true), 0.2);
  // One time constant after a step: 1 - 1/e.
  EXPECT_NEAR(motion.head_yaw_rad, 1 - std::exp(-1.0), 1e-9);
}

TEST(BirdMotion, ToesSpreadOnContactAndFoldInFlight) {
  const BirdSkeleton skeleton = FindParts(made::Biped());
  BirdMotion motion;
  for (int i = 0; i < 50; ++i) motion = Advance(motion, skeleton, Turned(0, true), 0.01);
  EXPECT_GT(motion.toe_spread[0], 0.99);
  EXPECT_LT(motion.wing_spread, 0.01);
  for (int i = 0; i < 50; ++i) motion = Advance(motion, skeleton, Turned(0, false), 0.01);
  EXPECT_LT(motion.toe_spread[0], 0.01);
  EXPECT_GT(motion.wing_spread, 0.9);
}

TEST(FindParts, GoesByNameNotByPlace) {
  stream::Skeleton skeleton = made::Biped();
  std::swap(skeleton.links[1], skeleton.links[3]);
  std::swap(skeleton.contact_points[0], skeleton.contact_points[1]);
  const BirdSkeleton found = FindParts(skeleton);
  EXPECT_EQ(found.hips[0], 3);
  EXPECT_EQ(found.feet[0], 1);
}

}  // namespace
}  // namespace footing::scene
