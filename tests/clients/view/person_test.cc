#include "clients/view/scene/figure.h"

#include <gtest/gtest.h>

#include "clients/view/scene/stage.h"
#include "clients/view/scene/text.h"
#include "tests/clients/view/made_person.h"
#include "tests/clients/view/made_stream.h"

namespace footing::scene {
namespace {

using made::PersonWish;

Picture Look(const Model& model, double time_s, const StageOptions& options = {}) {
  Stage stage;
  return stage.Advance(model, model.playout.Newest(), made::ClockAt(time_s), 0.01, options);
}

TEST(Anatomy, APersonIsKnownByItsNamesAndABirdIsNone) {
  const Anatomy person = FindAnatomy(made::PersonSkeleton());
  EXPECT_TRUE(person.person);
  EXPECT_TRUE(Fits(person, person.parents));
  EXPECT_FALSE(Fits(person, {-1, 0}));
  EXPECT_FALSE(FindAnatomy(made::Biped()).person);
  EXPECT_FALSE(FindAnatomy({}).person);
}

TEST(Anatomy, ATreeWhoseParentsAreNoTreeIsNotDrawn) {
  stream::Skeleton wrong = made::PersonSkeleton();
  wrong.links[3].parent = 900;
  const Anatomy anatomy = FindAnatomy(wrong);
  EXPECT_FALSE(anatomy.person);
  PartList parts;
  AddPerson(anatomy, std::vector<Eigen::Vector3d>(wrong.links.size()), {}, MannequinLook(), parts);
  EXPECT_TRUE(parts.limbs.empty());
}

TEST(Person, AnyOtherTreeIsDrawnAsALimbALink) {
  PartList parts;
  AddLimbs({-1, 0, 1}, {}, {{0, 0, 0}, {0, 0, 1}, {0, 1, 1}}, Rgb(0xffffff), parts);
  EXPECT_EQ(parts.limbs.size(), 2u);
}

TEST(Person, TheFigureIsAsTallAsItsBody) {
  PersonWish wish;
  wish.calibrated = false;  // Upright, arms out.
  const Model model = made::PersonModelAfter(0.1, wish);
  std::vector<Eigen::Vector3d> p_m;
  for (const auto& link : model.playout.Newest().characters[0].links) {
    p_m.push_back(link.position_m);
  }
  PartList parts;
  AddPerson(model.anatomy, p_m, {}, MannequinLook(), parts);
  float top = 0;
  for (const Part& ball : parts.balls) {
    const Eigen::Vector3f up = ball.X_WP.block<1, 3>(2, 0).transpose();
    top = std::max(top, ball.X_WP(2, 3) + up.norm());
  }
  EXPECT_NEAR(top, 1.75, 0.03);
}

TEST(Person, TheTrunkHasNoStep) {
  const Model model = made::PersonModelAfter(0.5, {});
  std::vector<Eigen::Vector3d> p_m;
  for (const auto& link : model.playout.Newest().characters[0].links) {
    p_m.push_back(link.position_m);
  }
  PartList parts;
  AddPerson(model.anatomy, p_m, {}, MannequinLook(), parts);
  // The shirt's pieces come first, one after the other: each begins where and as wide as the one
  // before ends.
  int joints = 0;
  for (std::size_t i = 1; i < 20; ++i) {
    const Part &before = parts.limbs[i - 1], &after = parts.limbs[i];
    if (before.colour != after.colour) continue;
    const Eigen::Vector4f end = before.X_WP.col(3) + before.X_WP.col(2);
    EXPECT_LT((end - after.X_WP.col(3)).norm(), 1e-4f) << i;
    EXPECT_NEAR(before.taper * before.X_WP.col(0).norm(), after.X_WP.col(0).norm(), 1e-4f) << i;
    ++joints;
  }
  EXPECT_EQ(joints, 18);
}

TEST(PersonStage, BeforeTheTPoseTheFigureIsASilhouette) {
  PersonWish wish;
  wish.calibrated = false;
  wish.reference = false;
  const Picture picture = Look(made::PersonModelAfter(0.5, wish), 0.5);
  EXPECT_TRUE(picture.studio);
  EXPECT_FALSE(picture.ghosts.balls.empty());
  EXPECT_FALSE(picture.figures.boxes.empty()) << "the boards are there to step on";
  wish.calibrated = true;
  EXPECT_TRUE(Look(made::PersonModelAfter(0.5, wish), 0.5).ghosts.balls.empty());
}

TEST(PersonStage, EachLoadedFootHasAnArrowWithItsForce) {
  const Model both = made::PersonModelAfter(0.5, {});
  const auto forces = [](const Picture& picture) {
    int count = 0;
    for (const Label& label : picture.labels) {
      count += label.text.size() > 2 && label.text.substr(label.text.size() - 2) == " N" ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(forces(Look(both, 0.5)), 2);
  PersonWish off;
  off.left_foot_off = true;
  EXPECT_EQ(forces(Look(made::PersonModelAfter(0.5, off), 0.5)), 1);
}

TEST(PersonStage, AReferenceThatFellSilentIsNotShown) {
  const Model model = made::PersonModelAfter(0.5, {});
  EXPECT_FALSE(Look(model, 0.5).ghosts.balls.empty());
  EXPECT_TRUE(Look(model, 2.0).ghosts.balls.empty());
}

TEST(BodySigns, TheEllipseIsTwoStandardDeviationsWide) {
  BodyFoot foot;
  foot.variance_m2 = {0.04 * 0.04, 0.01 * 0.01, 0};
  EXPECT_NEAR(FootEllipse(foot).x(), 0.08, 1e-6);
  EXPECT_NEAR(FootEllipse(foot).y(), 0.02, 1e-6);
}

TEST(ComTrail, KeepsFourSecondsAndBeginsAnewWithTheSimulation) {
  ComTrail trail;
  for (int i = 0; i <= 600; ++i) trail.Add(0.01 * i, {0.001 * i, 0, 1});
  EXPECT_GE(trail.points.front().time_s, 2.0 - 1e-9);
  trail.Add(0.5, {0, 0, 1});
  EXPECT_EQ(trail.points.size(), 1u);
}

TEST(Boards, CellsStandWhereTheLayoutSays) {
  PlacedBoard board;
  board.pose = {1, 2, 0};  // Front ahead, right to the right (-y).
  const auto sensors = board.Sensors();
  EXPECT_NEAR(sensors[1].x(), 1 + 0.238 / 2, 1e-12);  // Top right.
  EXPECT_NEAR(sensors[1].y(), 2 - 0.433 / 2, 1e-12);
}

TEST(PoseTally, ComparesEachPoseWithTheReferenceOfItsTime) {
  const Model model = made::PersonModelAfter(1, {});
  EXPECT_TRUE(model.pose_tally.calibrated());
  EXPECT_GT(model.pose_tally.compared(), 90u);
  EXPECT_NEAR(model.pose_tally.mpjpe_cm(), 0, 1e-9) << "the made reference is the pose itself";
  PersonWish lagging;
  lagging.lag_s = 0.2;  // Says that it is of 0.2 s ago, and is not.
  EXPECT_GT(made::PersonModelAfter(1, lagging).pose_tally.wrists_cm(), 2);
}

TEST(PoseTally, FramesThatAreNotValidCountInTheMeanAndBesideIt) {
  EXPECT_EQ(made::PersonModelAfter(1, {}).pose_tally.invalid(), 0u);
  PersonWish wish;
  wish.valid = false;
  const Model model = made::PersonModelAfter(1, wish);
  EXPECT_GT(model.pose_tally.compared(), 90u);
  EXPECT_EQ(model.pose_tally.invalid(), model.pose_tally.compared());
}

TEST(Words, TheTextViewTellsOfTheBody) {
  PersonWish wish;
  wish.left_foot_off = true;
  const std::string line = StatusLine(made::PersonModelAfter(1, wish), made::ClockAt(1));
  EXPECT_NE(line.find("71.0 kg"), std::string::npos) << line;
  EXPECT_NE(line.find("off 1.4 s"), std::string::npos) << line;
  wish.calibrated = false;
  EXPECT_NE(StatusLine(made::PersonModelAfter(1, wish), made::ClockAt(1)).find("T-pose 60 %"),
            std::string::npos);
}

}  // namespace
}  // namespace footing::scene
