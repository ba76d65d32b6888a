#include "common/virtual/options/load.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "common/base/units.h"
#include "common/body/body.h"
#include "common/body/landmarks.h"
#include "common/virtual/motion/bvh.h"

namespace footing::motion_files {
namespace {

using testing::HasSubstr;

std::string Shared() {
  const char* folder = std::getenv("FOOTING_TEST_DATA");
  return folder == nullptr ? "" : folder;
}

TEST(Load, ErrorsSayWhatIsExpected) {
  EXPECT_THAT(LoadMotion("x.fbx").error().message, HasSubstr("x.fbx: not a motion file: expected"));
  EXPECT_EQ(LoadMotion("x.fbx").error().kind, ErrorKind::kUsage);
  EXPECT_THAT(LoadMotion("/nowhere/x.bvh").error().message, HasSubstr("/nowhere/x.bvh"));
  EXPECT_THAT(LoadForces("x.bvh").error().message, HasSubstr("expected .mot"));
  EXPECT_THAT(LoadMarkers("x").error().message, HasSubstr("expected .trc"));
}

TEST(Load, ReadsEveryKindOfFile) {
  if (Shared().empty()) GTEST_SKIP() << "needs FOOTING_TEST_DATA";
  const std::string mocap = Shared() + "/mocap/", forces = Shared() + "/forces/";
  EXPECT_THAT(LoadMotion(mocap + "cmu_amc/01_01.amc").error().message, HasSubstr("--skeleton"));
  const auto amc = LoadMotion(mocap + "cmu_amc/01_01.amc", {.skeleton = mocap + "cmu_amc/01.asf"});
  ASSERT_TRUE(amc.ok()) << amc.error().message;
  EXPECT_EQ(amc->motion.frames(), 2751);
  const auto bvh = LoadMotion(mocap + "mass_bvh/walk.bvh");
  ASSERT_TRUE(bvh.ok()) << bvh.error().message;
  const auto trc = LoadMotion(forces + "osim/WeirdFormatTests/markers.trc");
  ASSERT_TRUE(trc.ok()) << trc.error().message;
  EXPECT_THAT(trc->note, HasSubstr("61 markers of set plug-in-gait fitted"));
  const auto plates = LoadForces(mocap + "c3d/JA1Gait35.c3d");
  ASSERT_TRUE(plates.ok()) << plates.error().message;
  EXPECT_EQ(plates->plates.size(), 8u);
}

/// A standing person's file, whose numbers are `per_m` to the metre.
std::string StandingPerson(double per_m, const char* name) {
  motion::Motion motion{body::StandardPerson(1.75), 60, 0, {}};
  for (body::Joint& joint : motion.skeleton.joints) joint.offset_m *= per_m / 100;
  motion.q = Eigen::MatrixXd::Zero(motion.skeleton.dof, 3);
  motion.q.row(2).setConstant(per_m / 100);
  const std::string path = testing::TempDir() + name;
  std::ofstream(path) << motion::WriteBvh(motion);
  return path;
}

TEST(Load, TheUnitOfABvhFileIsTheOneThatMakesAPerson) {
  const struct {
    double per_m;
    const char *file, *note;
  } kRows[] = {{100, "cm.bvh", ""},
               {1, "m.bvh", "metres: a person of 1.75 m"},
               {1000, "mm.bvh", "millimetres: a person of 1.75 m"},
               {1 / 0.0254, "in.bvh", "inches: a person of 1.75 m"}};
  for (const auto& row : kRows) {
    const auto read = LoadMotion(StandingPerson(row.per_m, row.file));
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_THAT(read->note, HasSubstr(row.note));
    EXPECT_EQ(read->note.empty(), row.per_m == 100);
    const body::Skeleton& skeleton = read->motion.skeleton;
    EXPECT_NEAR(body::EstimateHeight(skeleton, body::FindLandmarks(skeleton).value(), {}), 1.75,
                0.005)
        << row.file;
    EXPECT_NEAR(read->motion.q(2, 1), 1, 1e-4) << row.file;
  }
}

TEST(Load, AnUnlikelyUnitOfABvhFileIsAskedFor) {
  const std::string path = StandingPerson(17.7, "other.bvh");  // 5.65 cm, as of some archives.
  const auto refused = LoadMotion(path);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::kInvalidData);
  EXPECT_THAT(refused.error().message, HasSubstr("--bvh-unit-m"));
  const auto read = LoadMotion(path, {.bvh_unit_m = 1 / 17.7});
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_NEAR(read->motion.q(2, 1), 1, 1e-4);
}

TEST(Load, ARootThatJumpsIsAFaultOfTheRecording) {
  motion::Motion motion{body::StandardPerson(1.75), 60, 0, {}};
  motion.q = Eigen::MatrixXd::Zero(motion.skeleton.dof, 9);
  motion.q.row(2).setConstant(1);
  motion.q.row(0).tail(5).setConstant(1.5);  // 90 m/s.
  const std::string path = testing::TempDir() + "jump.bvh";
  std::ofstream(path) << motion::WriteBvh(motion);
  EXPECT_TRUE(LoadMotion(path).ok()) << LoadMotion(path).error().message;
  motion.q.row(0).tail(5).setConstant(1000);
  std::ofstream(path) << motion::WriteBvh(motion);
  const auto jump = LoadMotion(path);
  ASSERT_FALSE(jump.ok());
  EXPECT_EQ(jump.error().kind, ErrorKind::kInvalidData);
  EXPECT_THAT(jump.error().message,
              HasSubstr("jump.bvh: the root moves by 1e+03 m between frames 4 and 5 (0.067 s)"));
}

TEST(Load, WholeTurnsInAFileChangeNothing) {
  motion::Motion motion{body::StandardPerson(1.75), 60, 0, {}};
  motion.q.resize(motion.skeleton.dof, 30);
  for (Eigen::Index i = 0; i < motion.frames(); ++i) {
    for (int dof = 0; dof < motion.skeleton.dof; ++dof) {
      motion.q(dof, i) = 0.2 * std::sin(0.1 * static_cast<double>(i) + dof);
    }
  }
  const auto read = [&motion](const char* name) {
    const std::string path = testing::TempDir() + name;
    std::ofstream(path) << motion::WriteBvh(motion);
    return LoadMotion(path);
  };
  const auto plain = read("plain_turns.bvh");
  for (const int dof : {9, 21, 40}) motion.q.row(dof).array() += 4 * kPi;
  const auto turned = read("whole_turns.bvh");
  ASSERT_TRUE(plain.ok() && turned.ok());
  EXPECT_LT((plain->motion.q - turned->motion.q).cwiseAbs().maxCoeff(), 1e-6);
}

// The file has no POINT:Y_SCREEN, and y is up in it.
TEST(Load, APersonStandsUpWhereTheFileDoesNotSayWhichWayIsUp) {
  if (Shared().empty()) GTEST_SKIP() << "needs FOOTING_TEST_DATA";
  const auto tracks = LoadMarkers(Shared() + "/mocap/c3d/squat.c3d");
  ASSERT_TRUE(tracks.ok()) << tracks.error().message;
  const auto first = [&](const char* name) -> Eigen::Vector3d {
    const int marker = motion::FindMarker(*tracks, std::string("SehoonVSK35:") + name);
    return marker < 0 ? Eigen::Vector3d::Constant(NAN)
                      : Eigen::Vector3d(tracks->p[static_cast<std::size_t>(marker)].col(0));
  };
  EXPECT_NEAR(first("ARIEL").z(), 1.76, 0.01);  // On the head,
  EXPECT_NEAR(first("LHEL").z(), 0.11, 0.01);   // and on the heels.
  EXPECT_NEAR(first("RHEL").z(), 0.12, 0.01);
}

}  // namespace
}  // namespace footing::motion_files
