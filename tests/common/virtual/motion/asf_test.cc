#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/virtual/motion/asf.h"
#include "common/virtual/motion/bvh.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/motion/table.h"
#include "tests/common/virtual/motion/shared_data.h"

namespace footing::motion {
namespace {

using testing::HasSubstr;

// One leg: a bone that does not turn, and two that do, about axes of their own.
constexpr const char* kAsf = R"(# a comment
:version 1.10
:name LEG
:units
  mass 1.0
  length 0.45
  angle deg
:documentation
   anything at all
:root
   order TX TY TZ RX RY RZ
   axis XYZ
   position 0 0 0
   orientation 0 0 0
:bonedata
  begin
     id 1
     name hipjoint
     direction 0 -1 0
     length 2
     axis 0 0 0 XYZ
  end
  begin
     id 2
     name femur
     direction 0 -1 0
     length 8
     axis 0 90 0 XYZ
    dof rx ry
    limits (-160.0 20.0)
           (-70.0 70.0)
  end
  begin
     id 3
     name tibia
     direction 0 -2 0
     length 7
     axis 0 0 0 XYZ
    dof rx
  end
:hierarchy
  begin
    root hipjoint
    hipjoint femur
    femur tibia
  end
)";

constexpr const char* kAmc = R"(#!OML:ASF
:FULLY-SPECIFIED
:DEGREES
1
root 1 16 2 0 0 0
femur 0 0
tibia 0
2
root 1 16 2 0 30 0
tibia 90
femur 90 0
)";

constexpr double kUnitM = 0.0254 / 0.45;

std::string With(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

Motion Read(const std::string& asf = kAsf, const std::string& amc = kAmc) {
  return ParseAmc(amc, "leg.amc", ParseAsf(asf, "leg.asf").value()).value();
}

Eigen::Vector3d Place(const Motion& motion, Eigen::Index frame, const char* joint) {
  body::Kinematics at(motion.skeleton);
  ComputeKinematics(motion.skeleton, motion.q.col(frame), at);
  return at.p_WJ[static_cast<std::size_t>(body::FindJoint(motion.skeleton, joint))];
}

TEST(Asf, BonesHangEndToEndInCmuUnits) {
  const Motion motion = Read();
  // File (1, 16, 2) is W (2, 1, 16); the leg hangs 2 + 8 + 7 down.
  EXPECT_TRUE(Place(motion, 0, "femur").isApprox(kUnitM * Eigen::Vector3d(2, 1, 14), 1e-9));
  EXPECT_TRUE(Place(motion, 0, "tibia").isApprox(kUnitM * Eigen::Vector3d(2, 1, 6), 1e-9));
  EXPECT_TRUE(Place(motion, 0, "tibia_end").isApprox(kUnitM * Eigen::Vector3d(2, 1, -1), 1e-9));
}

TEST(Asf, ABoneTurnsAboutItsOwnAxes) {
  const Motion motion = Read();
  // Its x axis is the file's x turned by 90 degrees about y: -z. A turn of 90 degrees about -z
  // takes down (0, -1, 0) to (-1, 0, 0) of the file. The whole is then turned by 30 degrees about
  // up (y), which takes (-1, 0, 0) to (-cos 30, 0, sin 30).
  const double c = std::cos(kPi / 6), s = std::sin(kPi / 6);
  const Eigen::Vector3d root(2, 1, 16);  // W
  const Eigen::Vector3d knee = root + Eigen::Vector3d(8 * s, -8 * c, -2);
  EXPECT_TRUE(Place(motion, 1, "tibia").isApprox(kUnitM * knee, 1e-9))
      << Place(motion, 1, "tibia").transpose() / kUnitM;
}

TEST(Asf, TheRootTurnsByHeadingRollAndPitch) {
  const Motion motion = Read();
  // 30 degrees about up: heading, the first of the three.
  EXPECT_NEAR(motion.q(3, 1), kPi / 6, 1e-12);
  EXPECT_NEAR(motion.q(4, 1), 0, 1e-12);
  EXPECT_NEAR(motion.q(5, 1), 0, 1e-12);
}

TEST(Asf, LimitsGoWithTheirDegreesOfFreedom) {
  const auto asf = ParseAsf(kAsf, "leg.asf").value();
  const body::Joint& femur = asf.skeleton.joint(body::FindJoint(asf.skeleton, "femur"));
  ASSERT_EQ(femur.rotations.size(), 2u);
  // In the order of the product: y (z of W) before x (y of W).
  EXPECT_EQ(femur.rotations[0].axis, body::Axis::kZ);
  EXPECT_NEAR(femur.rotations[0].lower_rad, DegreesToRadians(-70), 1e-12);
  EXPECT_EQ(femur.rotations[1].axis, body::Axis::kY);
  EXPECT_NEAR(femur.rotations[1].lower_rad, DegreesToRadians(-160), 1e-12);
}

TEST(Asf, RadiansAreTakenWhereTheFileSaysSo) {
  const Motion degrees = Read();
  const Motion radians =
      Read(kAsf, With(With(With(kAmc, ":DEGREES", ":RADIANS"), "0 30 0", "0 0.523598775598 0"),
                      "tibia 90\nfemur 90", "tibia 1.570796326795\nfemur 1.570796326795"));
  EXPECT_LT((degrees.q - radians.q).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Asf, ABoneWithoutLengthIsAPoint) {
  const auto asf = ParseAsf(With(kAsf, "     length 2\n", ""), "leg.asf");
  ASSERT_TRUE(asf.ok()) << asf.error().message;
  EXPECT_TRUE(asf->skeleton.joint(body::FindJoint(asf->skeleton, "femur")).offset_m.isZero());
}

TEST(Asf, ErrorsSayFileLineAndWhatWasExpected) {
  const struct {
    std::string text, message;
  } kRows[] = {
      {"", "not an ASF file"},
      {With(kAsf, "length 8", "length x"), "leg.asf, line 27: expected a number of length"},
      {With(kAsf, "dof rx ry", "dof rx l"), "slide or stretch"},
      {With(kAsf, "dof rx ry", "dof rx rx"), "stands twice"},
      {With(kAsf, "90 0 XYZ", "90 0 XYX"), "expected an order of axes"},
      {With(kAsf, "(-160.0 20.0)", "(20 -160)"), "the wrong way"},
      {With(kAsf, "femur tibia", "femur fibula"), "no bone 'fibula'"},
      {With(kAsf, "    femur tibia\n", ""), "tibia hangs on nothing"},
      {With(kAsf, "    femur tibia\n", "    femur tibia\n hipjoint tibia\n"), "two parents"},
  };
  for (const auto& row : kRows) {
    const auto asf = ParseAsf(row.text, "leg.asf");
    ASSERT_FALSE(asf.ok()) << row.message;
    EXPECT_THAT(asf.error().message, HasSubstr(row.message));
  }
}

TEST(Amc, ErrorsSayFileLineAndWhatWasExpected) {
  const auto asf = ParseAsf(kAsf, "leg.asf").value();
  const struct {
    std::string text, message;
  } kRows[] = {
      {":DEGREES\n", "no frame"},
      {With(kAmc, "femur 0 0", "femur 0"), "leg.amc, line 6: expected a number of femur"},
      {With(kAmc, "femur 0 0", "femur 0 0 0"), "more numbers than femur"},
      {With(kAmc, "femur 0 0", "thigh 0 0"), "'thigh' is not in the skeleton"},
      {With(kAmc, "femur 0 0\n", ""), "frame 1 ends without femur"},
      {With(kAmc, "tibia 0", "tibia 0\ntibia 0"), "a second tibia"},
      {With(kAmc, "1\nroot", "one\nroot"), "expected the number of a frame"},
      {With(kAmc, "2\nroot", "5\nroot"), "frame 5 follows frame 1; frames are missing"},
  };
  for (const auto& row : kRows) {
    const auto motion = ParseAmc(row.text, "leg.amc", asf);
    ASSERT_FALSE(motion.ok()) << row.message;
    EXPECT_THAT(motion.error().message, HasSubstr(row.message));
  }
}

using test::ReadShared;

struct Clip {
  const char *skeleton, *motion;
  Eigen::Index frames;
};

TEST(SharedData, CmuClipsAreReadAndStandOnTheFloor) {
  SKIP_WITHOUT_SHARED_DATA();
  for (const Clip& clip : {Clip{"13_reconstructed", "13_30", 2465}, Clip{"01", "01_01", 2751}}) {
    const std::string folder = "mocap/cmu_amc/";
    const auto asf = ParseAsf(ReadShared(folder + clip.skeleton + ".asf"), clip.skeleton);
    ASSERT_TRUE(asf.ok()) << asf.error().message;
    const auto motion = ParseAmc(ReadShared(folder + clip.motion + ".amc"), clip.motion, *asf);
    ASSERT_TRUE(motion.ok()) << motion.error().message;
    EXPECT_EQ(motion->skeleton.dof, 62);
    EXPECT_EQ(motion->frames(), clip.frames);
    body::Kinematics at(motion->skeleton);
    double lowest_m = 9;
    for (Eigen::Index frame = 0; frame < motion->frames(); ++frame) {
      ComputeKinematics(motion->skeleton, motion->q.col(frame), at);
      for (const auto& p_W : at.p_WJ) lowest_m = std::min(lowest_m, p_W.z());
    }
    EXPECT_NEAR(lowest_m, 0, 0.05) << clip.motion;
    const auto body = body::MakeBody(motion->skeleton, {});
    ASSERT_TRUE(body.ok()) << body.error().message;
    EXPECT_GT(body->height_m, 1.6);
    EXPECT_LT(body->height_m, 1.95);
  }
}

TEST(SharedData, AStandardPersonHasTheCoordinatesOfACmuSkeletonWithoutFingers) {
  SKIP_WITHOUT_SHARED_DATA();
  const auto asf = ParseAsf(ReadShared("mocap/cmu_amc/13_reconstructed.asf"), "13");
  ASSERT_TRUE(asf.ok()) << asf.error().message;
  auto names = body::DofNames(asf->skeleton);
  std::erase_if(names, [](const std::string& name) {
    return name.find("fingers") != std::string::npos || name.find("thumb") != std::string::npos;
  });
  const body::Skeleton standard = body::StandardPerson(1.75);
  EXPECT_EQ(names, body::DofNames(standard));
  for (int i = 0; i < standard.size(); ++i) {
    const body::Joint& joint = standard.joint(i);
    const int other = body::FindJoint(asf->skeleton, joint.name);
    if (other < 0) continue;
    EXPECT_TRUE(joint.axes.isApprox(asf->skeleton.joint(other).axes, 1e-4)) << joint.name;
  }
}

TEST(SharedData, BvhFilesAreReadAndOurOutputOfThemIsStable) {
  SKIP_WITHOUT_SHARED_DATA();
  for (const char* path : {"mocap/mass_bvh/walk.bvh", "mocap/cmu_bvh/002_04.bvh"}) {
    const auto motion = ParseBvh(ReadShared(path), path);
    ASSERT_TRUE(motion.ok()) << motion.error().message;
    const std::string once = WriteBvh(*motion);
    EXPECT_EQ(WriteBvh(ParseBvh(once, path).value()), once) << path;
    EXPECT_TRUE(body::FindLandmarks(motion->skeleton).ok()) << path;
  }
}

TEST(SharedData, MarkersOfEveryLaboratoryAreRead) {
  SKIP_WITHOUT_SHARED_DATA();
  const struct {
    const char* path;
    std::size_t markers;
    Eigen::Index frames;
  } kRows[] = {{"forces/opencap_s4/MarkerData/squats1.trc", 51, 1346},
               {"forces/osim/AddBiomechanics/motion_capture_walk.trc", 41, 238},
               {"forces/osim/Tiziana2019/markers.trc", 29, 185},
               {"forces/osim/WeirdFormatTests/markers.trc", 61, 281}};
  for (const auto& row : kRows) {
    const auto tracks = ParseTrc(ReadShared(row.path), row.path);
    ASSERT_TRUE(tracks.ok()) << tracks.error().message;
    EXPECT_EQ(tracks->names.size(), row.markers) << row.path;
    EXPECT_EQ(tracks->frames(), row.frames) << row.path;
  }
}

TEST(SharedData, TheForcesUnderASquatAreTheSubjectsWeight) {
  SKIP_WITHOUT_SHARED_DATA();
  const char* path = "forces/opencap_s4/ID/squats1_grf.mot";
  const auto table = ParseTable(ReadShared(path), path);
  ASSERT_TRUE(table.ok()) << table.error().message;
  const auto forces = ToGroundForces(*table, path);
  ASSERT_TRUE(forces.ok()) << forces.error().message;
  double mean_n = 0;
  for (const PlateForces& plate : forces->plates) mean_n += plate.force_W.row(2).mean();
  EXPECT_NEAR(mean_n, 60.0 * 9.80665, 10);  // 60.0 kg by the static trial.
}

TEST(SharedData, C3dOfMarkersAndOfPlatesIsRead) {
  SKIP_WITHOUT_SHARED_DATA();
  const auto read = [](const char* name) {
    const std::string text = ReadShared(std::string("mocap/c3d/") + name);
    return ParseC3d({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, name);
  };
  const auto squat = read("squat.c3d");
  ASSERT_TRUE(squat.ok()) << squat.error().message;
  EXPECT_EQ(squat->points.names.size(), 53u);
  EXPECT_EQ(squat->points.frames(), 2539);
  const auto sprint = read("JA1Gait35.c3d");
  ASSERT_TRUE(sprint.ok()) << sprint.error().message;
  EXPECT_EQ(sprint->plates.size(), 8u);
  const auto forces = ToGroundForces(*sprint, "JA1Gait35.c3d");
  ASSERT_TRUE(forces.ok()) << forces.error().message;
  // The foot on the second plate pushes the sprinter up, and its toe marker is over the COP.
  const PlateForces& plate = forces->plates[1];
  Eigen::Index sample = 0;
  EXPECT_GT(plate.force_W.row(2).maxCoeff(&sample), 2000);
  const auto toe = static_cast<std::size_t>(FindMarker(sprint->points, "RTOE"));
  const Eigen::Vector3d p = sprint->points.p[toe].col(sample / 6);
  EXPECT_LT((p - plate.cop_W.col(sample)).head<2>().norm(), 0.15);
}

}  // namespace
}  // namespace footing::motion
