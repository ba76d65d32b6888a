#include "clients/view/scene/figure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "clients/view/scene/stage.h"
#include "clients/view/scene/text.h"
#include "common/base/units.h"
#include "tests/clients/view/made_person.h"
#include "tests/clients/view/made_stream.h"

namespace footing::scene {
namespace {

using body::Axis;
using body::Landmark;
using Eigen::Vector3d;
using made::PersonWish;

Picture Look(const Model& model, double time_s, const StageOptions& options = {}) {
  Stage stage;
  return stage.Advance(model, model.playout.Newest(), made::ClockAt(time_s), 0.01, options);
}

PartList Drawn(const PersonPose& pose) {
  PartList parts;
  AddPerson(FindAnatomy(made::PersonSkeleton()), pose, MannequinLook(), parts);
  return parts;
}

Vector3d PlaceOf(const PersonPose& pose, Landmark landmark) {
  const int joint = FindAnatomy(made::PersonSkeleton()).landmarks[landmark];
  return pose.p_m[static_cast<std::size_t>(joint)];
}

/// Under the skin of some limb or ball, as the shaders of the renderer shape them.
bool Covers(const PartList& parts, const Vector3d& p_m) {
  const Eigen::Vector4f p = p_m.cast<float>().homogeneous();
  const auto in_limb = [&](const Part& limb) {
    const Eigen::Vector4f at = limb.X_WP.inverse() * p;
    const float along = std::clamp(at.z(), 0.0f, 1.0f);
    const float beyond = (at.z() - along) * limb.X_WP.col(2).norm() / limb.X_WP.col(0).norm();
    return std::hypot(at.x(), at.y(), beyond) <= 1 + (limb.taper - 1) * along;
  };
  const auto in_ball = [&](const Part& ball) {
    return (ball.X_WP.inverse() * p).head<3>().norm() <= 1;
  };
  return std::any_of(parts.limbs.begin(), parts.limbs.end(), in_limb) ||
         std::any_of(parts.balls.begin(), parts.balls.end(), in_ball);
}

/// A limb's root: from the flesh of the trunk to that of a quarter of the limb, straight lines on
/// all sides of both, at 0.8 of their thickness.
struct Root {
  Vector3d trunk_m, joint_m, limb_m;
  double trunk_radius_m = 0, limb_radius_m = 0;
};

int LinesThroughTheAir(const PartList& parts, const Root& root) {
  const Eigen::Quaterniond hanging =
      Eigen::Quaterniond::FromTwoVectors(-Vector3d::UnitZ(), root.limb_m - root.joint_m);
  int outside = 0;
  for (int side = 0; side < 16; ++side) {
    const Vector3d out(std::cos(side * kPi / 8), std::sin(side * kPi / 8), 0);
    const Vector3d from_m = root.trunk_m + 0.8 * root.trunk_radius_m * out;
    const Vector3d to_m = root.limb_m + 0.8 * root.limb_radius_m * (hanging * out);
    bool covered = true;
    for (int i = 0; i <= 20; ++i) covered &= Covers(parts, from_m + i / 20.0 * (to_m - from_m));
    outside += covered ? 0 : 1;
  }
  return outside;
}

constexpr double kStatureM = 1.75;

Root HipOf(const PersonPose& pose) {
  const Vector3d hip_m = PlaceOf(pose, Landmark::kLeftHip);
  const Vector3d middle_m = 0.5 * (hip_m + PlaceOf(pose, Landmark::kRightHip));
  const Vector3d above_m(0, 0, 0.03 * kStatureM);
  return {middle_m + 0.6 * (hip_m - middle_m) + above_m, hip_m,
          hip_m + 0.25 * (PlaceOf(pose, Landmark::kLeftKnee) - hip_m), 0.055 * kStatureM,
          0.048 * kStatureM};
}

Root ShoulderOf(const PersonPose& pose) {
  const Vector3d shoulder_m = PlaceOf(pose, Landmark::kLeftShoulder);
  const Vector3d hips_m =
      0.5 * (PlaceOf(pose, Landmark::kLeftHip) + PlaceOf(pose, Landmark::kRightHip));
  const Vector3d aside_m(0, 0.05 * kStatureM, 0);
  return {hips_m + 0.75 * (PlaceOf(pose, Landmark::kNeck) - hips_m) + aside_m, shoulder_m,
          shoulder_m + 0.25 * (PlaceOf(pose, Landmark::kLeftElbow) - shoulder_m), 0.055 * kStatureM,
          0.034 * kStatureM};
}

TEST(Figure, TheSkinDoesNotSplitAtTheHipUpTo120Degrees) {
  for (int degrees = 0; degrees <= 120; degrees += 20) {
    const double angle_rad = DegreesToRadians(degrees);
    const PersonPose lifted = made::Bent({{Landmark::kLeftHip, Axis::kY, -angle_rad}});
    EXPECT_EQ(LinesThroughTheAir(Drawn(lifted), HipOf(lifted)), 0) << degrees;
    const PersonPose aside = made::Bent({{Landmark::kLeftHip, Axis::kX, 0.5 * angle_rad}});
    EXPECT_EQ(LinesThroughTheAir(Drawn(aside), HipOf(aside)), 0) << degrees;
  }
}

TEST(Figure, TheSkinDoesNotSplitAtTheShoulderUpTo120Degrees) {
  const made::Bend down{Landmark::kLeftShoulder, Axis::kX, DegreesToRadians(-80)};
  for (int degrees = 0; degrees <= 120; degrees += 20) {
    for (const made::Bend& lift :
         {made::Bend{Landmark::kLeftShoulder, Axis::kY, DegreesToRadians(-degrees)},
          made::Bend{Landmark::kLeftShoulder, Axis::kX, DegreesToRadians(degrees)}}) {
      const PersonPose pose = made::Bent({down, lift});
      EXPECT_EQ(LinesThroughTheAir(Drawn(pose), ShoulderOf(pose)), 0) << degrees;
    }
  }
}

/// The mean place of the balls of that colour, W.
Vector3d MiddleOf(const PartList& parts, const Colour& colour) {
  Vector3d sum_m = Vector3d::Zero();
  int count = 0;
  for (const Part& ball : parts.balls) {
    if (ball.colour != colour) continue;
    sum_m += ball.X_WP.topRightCorner<3, 1>().cast<double>();
    ++count;
  }
  return sum_m / count;
}

TEST(Figure, TheFaceLooksWhereTheHeadDoes) {
  for (const double turn_rad : {-0.8, 0.0, 0.5}) {
    const PersonPose pose = made::Bent({{Landmark::kHead, Axis::kZ, turn_rad}});
    const Vector3d look_m =
        MiddleOf(Drawn(pose), MannequinLook().eyes) - PlaceOf(pose, Landmark::kVertex);
    EXPECT_NEAR(std::atan2(look_m.y(), look_m.x()), turn_rad, 0.05);
    PersonPose unknown = pose;
    unknown.orientations.clear();
    const Vector3d ahead_m =
        MiddleOf(Drawn(unknown), MannequinLook().eyes) - PlaceOf(unknown, Landmark::kVertex);
    EXPECT_NEAR(std::atan2(ahead_m.y(), ahead_m.x()), 0, 0.05);
  }
}

TEST(Figure, ASilhouetteIsDrawnOfFewerParts) {
  const PersonPose pose = made::Bent({});
  const Anatomy anatomy = FindAnatomy(made::PersonSkeleton());
  PartList plain;
  AddPerson(anatomy, pose, PlainLook(Rgb(0x8fd6ff)), plain);
  const PartList full = Drawn(pose);
  EXPECT_LT(plain.limbs.size() + 15, full.limbs.size());
  EXPECT_LT(plain.balls.size() + 8, full.balls.size());
}

TEST(Figure, AHandIsClosedAroundARod) {
  const PersonPose pose = made::Bent({});
  const PartList parts = Drawn(pose);
  const Vector3d wrist_m = PlaceOf(pose, Landmark::kLeftWrist);
  // In the T-pose: the rod is below the knuckles and points ahead, with free room around its axis.
  const Vector3d rod_m = wrist_m + kStatureM * Vector3d(0.006, 0.047, -0.0155);
  EXPECT_FALSE(Covers(parts, rod_m));
  int closed = 0;
  for (const double degrees : {90.0, 45.0, 0.0, -45.0, -90.0}) {
    const double angle_rad = DegreesToRadians(degrees);
    const Vector3d out(0, std::cos(angle_rad), std::sin(angle_rad));
    bool met = false;
    for (double away = 0; away < 0.02; away += 0.001)
      met |= Covers(parts, rod_m + away * kStatureM * out);
    closed += met ? 1 : 0;
  }
  EXPECT_EQ(closed, 5) << "of five directions from the back of the hand to the finger tips";
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
  PersonPose pose;
  pose.p_m.resize(wrong.links.size());
  AddPerson(anatomy, pose, MannequinLook(), parts);
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
  PersonPose pose;
  for (const auto& link : model.playout.Newest().characters[0].links) {
    pose.p_m.push_back(link.position_m);
  }
  PartList parts;
  AddPerson(model.anatomy, pose, MannequinLook(), parts);
  float top = 0;
  for (const Part& ball : parts.balls) {
    const Eigen::Vector3f up = ball.X_WP.block<1, 3>(2, 0).transpose();
    top = std::max(top, ball.X_WP(2, 3) + up.norm());
  }
  EXPECT_NEAR(top, 1.75, 0.03);
}

TEST(Person, TheTrunkHasNoStep) {
  const PartList parts = Drawn(made::Bent({{Landmark::kLeftHip, Axis::kY, -0.6}}));
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
