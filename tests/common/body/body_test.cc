#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "tests/common/body/poses.h"

namespace footing::body {
namespace {

using test::kHeightM;
using test::StandardBody;
using testing::HasSubstr;

TEST(Segments, TheMassesOfEachSexSumToOne) {
  for (Sex sex : {Sex::kFemale, Sex::kMale, Sex::kMean}) {
    double sum = 0;
    for (int i = 0; i < kSegmentCount; ++i) {
      const auto segment = static_cast<Segment>(i);
      sum += (segment >= Segment::kUpperArm ? 2 : 1) * Parameters(segment, sex).mass_of_body;
    }
    EXPECT_NEAR(sum, 1, 1e-12);
  }
}

TEST(Segments, ThePartsOfTheTrunkMakeUpDeLevasWholeTrunk) {
  // Whole trunk, cervicale to mid-hip: centre at 51.38 % (male) and 49.64 % (female) from the
  // cervicale, in the same table, whose parts and whole agree to 3 mm in 603.
  const struct {
    Sex sex;
    double centre_of_length;
  } kRows[] = {{Sex::kMale, 0.5138}, {Sex::kFemale, 0.4964}};
  for (const auto& row : kRows) {
    double mass = 0, moment = 0;
    for (Segment part : {Segment::kUpperTrunk, Segment::kMiddleTrunk, Segment::kLowerTrunk}) {
      mass += Parameters(part, row.sex).mass_of_body;
      moment += Parameters(part, row.sex).mass_of_body * TrunkCentre(part, row.sex);
    }
    EXPECT_NEAR(1 - moment / mass / CervicaleOnTrunk(row.sex), row.centre_of_length, 0.006);
  }
}

TEST(Body, MassesSumToThePersonsAndScaleWithHim) {
  for (double mass_kg : {45.0, 110.0}) {
    const Body body = StandardBody(mass_kg);
    double sum = 0;
    for (const JointMass& mass : body.masses) sum += mass.mass_kg;
    EXPECT_NEAR(sum, mass_kg, 1e-9);
  }
  const Body light = StandardBody(50), heavy = WithMass(light, 100);
  const auto hip = static_cast<std::size_t>(light.landmarks[Landmark::kLeftHip]);
  EXPECT_NEAR(heavy.masses[hip].mass_kg, 2 * light.masses[hip].mass_kg, 1e-12);
  EXPECT_TRUE(heavy.masses[hip].inertia_J.isApprox(2 * light.masses[hip].inertia_J));
  EXPECT_EQ(heavy.masses[hip].com_J, light.masses[hip].com_J);
}

TEST(Body, TheThighsInertiaIsMassTimesSquareOfItsRadius) {
  const Body body = StandardBody(70);
  const auto hip = static_cast<std::size_t>(body.landmarks[Landmark::kLeftHip]);
  const SegmentParameters row = Parameters(Segment::kThigh, Sex::kMean);
  const double length_m = row.length_of_stature * kHeightM;
  const Eigen::Vector3d along = body.masses[hip].com_J.normalized();
  const double mass = 70 * row.mass_of_body;
  EXPECT_NEAR(body.masses[hip].mass_kg, mass, 1e-9);
  EXPECT_NEAR(body.masses[hip].com_J.norm(), row.centre_of_length * length_m, 1e-9);
  EXPECT_NEAR(along.dot(body.masses[hip].inertia_J * along),
              mass * std::pow(row.longitudinal_radius * length_m, 2), 1e-12);
}

TEST(Body, TheCentreOfMassOfATPoseIsWhereDeLevaHasIt) {
  // Standing with arms down it is 0.55 to 0.58 of the height over the floor; level arms raise it by
  // about 2 (0.0263 + 0.0150 + 0.0059) * their rise (0.1 to 0.35 m) / height: 0.01.
  const Body body = StandardBody();
  Kinematics at(body.skeleton);
  ComputeKinematics(body.skeleton, TPose(body.skeleton, body.landmarks), at);
  const Eigen::Vector3d com = CentreOfMass(body, at);
  EXPECT_NEAR(com.y(), 0, 1e-9);
  EXPECT_GT(com.z(), 0.55 * kHeightM);
  EXPECT_LT(com.z(), 0.60 * kHeightM);
  const auto ankle = static_cast<std::size_t>(body.landmarks[Landmark::kLeftAnkle]);
  const auto toe = static_cast<std::size_t>(body.landmarks[Landmark::kLeftToeEnd]);
  EXPECT_GT(com.x(), at.p_WJ[ankle].x() - 0.05);  // Over the feet: no fall.
  EXPECT_LT(com.x(), at.p_WJ[toe].x());
}

TEST(Body, AnEstimatedHeightIsTheStandardPersonsOwn) {
  for (Sex sex : {Sex::kFemale, Sex::kMale, Sex::kMean}) {
    const Skeleton skeleton = StandardPerson(1.62, sex);
    PersonParameters person;
    person.sex = sex;
    const double height_m = EstimateHeight(skeleton, FindLandmarks(skeleton).value(), person);
    EXPECT_NEAR(height_m, 1.62, 0.03);
  }
}

TEST(Body, RefusesWhatIsNoPerson) {
  PersonParameters person;
  person.mass_kg = 5;
  EXPECT_THAT(MakeBody(StandardPerson(1.7), person).error().message, HasSubstr("mass of 5"));
  person.mass_kg = std::nan("");
  EXPECT_FALSE(MakeBody(StandardPerson(1.7), person).ok());
  person.mass_kg = 70;
  EXPECT_THAT(MakeBody(StandardPerson(170), person).error().message, HasSubstr("other units"));
  Skeleton flat = StandardPerson(1.7);
  for (Joint& joint : flat.joints) joint.offset_m.setZero();
  person.height_m = 1.7;
  EXPECT_THAT(MakeBody(flat, person).error().message, HasSubstr("in one place"));
}

class EverySex : public testing::TestWithParam<Sex> {};

TEST_P(EverySex, HasFiftySixDegreesOfFreedomAndTheHeightAskedFor) {
  const Skeleton skeleton = StandardPerson(1.68, GetParam());
  EXPECT_EQ(skeleton.dof, 56);
  const Landmarks landmarks = FindLandmarks(skeleton).value();
  Kinematics at(skeleton);
  ComputeKinematics(skeleton, TPose(skeleton, landmarks), at);
  double top_m = 0, bottom_m = 9;
  for (const Eigen::Vector3d& p_W : at.p_WJ) {
    top_m = std::max(top_m, p_W.z());
    bottom_m = std::min(bottom_m, p_W.z());
  }
  EXPECT_NEAR(bottom_m, 0, 1e-9);
  // The lowest joint is the ball of the foot, 0.015 of the height over the sole.
  EXPECT_NEAR(top_m, 1.68 * (1 - 0.015), 0.005);
}

TEST_P(EverySex, IsTheSameLeftAndRight) {
  const Skeleton skeleton = StandardPerson(1.75, GetParam());
  const Landmarks landmarks = FindLandmarks(skeleton).value();
  Kinematics at(skeleton);
  ComputeKinematics(skeleton, TPose(skeleton, landmarks), at);
  for (int i = 0; i < kLandmarkCount; ++i) {
    const auto landmark = static_cast<Landmark>(i);
    const Eigen::Vector3d here = at.p_WJ[static_cast<std::size_t>(landmarks[landmark])];
    const Eigen::Vector3d there = at.p_WJ[static_cast<std::size_t>(landmarks[Mirrored(landmark)])];
    EXPECT_LT((here - Eigen::Vector3d(there.x(), -there.y(), there.z())).norm(), 1e-9)
        << LandmarkName(landmark);
  }
}

TEST_P(EverySex, LooksAheadWithArmsOutAndToesInFront) {
  const Skeleton skeleton = StandardPerson(1.75, GetParam());
  const Landmarks landmarks = FindLandmarks(skeleton).value();
  Kinematics at(skeleton);
  ComputeKinematics(skeleton, TPose(skeleton, landmarks), at);
  const auto place = [&](Landmark l) { return at.p_WJ[static_cast<std::size_t>(landmarks[l])]; };
  EXPECT_GT(place(Landmark::kLeftHandEnd).y(), 0.75);
  EXPECT_NEAR(place(Landmark::kLeftHandEnd).z(), place(Landmark::kLeftShoulder).z(), 1e-6);
  EXPECT_GT(place(Landmark::kLeftToeEnd).x(), place(Landmark::kLeftAnkle).x() + 0.15);
  EXPECT_NEAR(place(Landmark::kLeftKnee).y(), place(Landmark::kLeftHip).y(), 1e-6);
}

TEST(StandardPerson, AKneeBendsBackAndAnElbowInFront) {
  const Skeleton skeleton = StandardPerson(1.75);
  const Landmarks landmarks = FindLandmarks(skeleton).value();
  Eigen::VectorXd q = TPose(skeleton, landmarks);
  Kinematics straight(skeleton), bent(skeleton);
  ComputeKinematics(skeleton, q, straight);
  const auto knee = skeleton.joint(landmarks[Landmark::kLeftKnee]).first_dof;
  q(knee) = 1;
  ComputeKinematics(skeleton, q, bent);
  const auto ankle = static_cast<std::size_t>(landmarks[Landmark::kLeftAnkle]);
  EXPECT_LT(bent.p_WJ[ankle].x(), straight.p_WJ[ankle].x() - 0.2);
}

INSTANTIATE_TEST_SUITE_P(Sexes, EverySex, testing::Values(Sex::kFemale, Sex::kMale, Sex::kMean));

}  // namespace
}  // namespace footing::body
