#include "common/virtual/options/load.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "common/base/units.h"
#include "common/body/body.h"
#include "common/body/kinematics.h"
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
               {1 / 0.0254, "in.bvh", "inches: a person of 1.75 m"},
               {0.45 / 0.0254, "cmu.bvh", "CMU's units of 5.64 cm: a person of 1.75 m"}};
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
  const std::string path = StandingPerson(5, "other.bvh");  // 20 cm.
  const auto refused = LoadMotion(path);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::kInvalidData);
  EXPECT_THAT(refused.error().message, HasSubstr("--bvh-unit-m"));
  const auto read = LoadMotion(path, {.bvh_unit_m = 0.2});
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
              HasSubstr("jump.bvh: the root moves by 1000.0 m between frames 4 and 5 (0.067 s)"));
}

TEST(Load, AJumpOfMetresIsAFaultAtALowRateToo) {
  motion::Motion motion{body::StandardPerson(1.75), 10, 0, {}};
  motion.q = Eigen::MatrixXd::Zero(motion.skeleton.dof, 9);
  motion.q.row(2).setConstant(1);
  motion.q.row(0).tail(5).setConstant(5);  // 50 m/s.
  const std::string path = testing::TempDir() + "slow_jump.bvh";
  std::ofstream(path) << motion::WriteBvh(motion);
  const auto jump = LoadMotion(path);
  ASSERT_FALSE(jump.ok());
  EXPECT_THAT(jump.error().message, HasSubstr("the root moves by 5.0 m between frames 4 and 5"));
}

TEST(Load, ABoneThatNobodyHasIsNamed) {
  motion::Motion motion{body::StandardPerson(1.75), 60, 0, {}};
  motion.q = Eigen::MatrixXd::Zero(motion.skeleton.dof, 9);
  motion.q.row(2).setConstant(1);
  const int wrist = body::FindLandmarks(motion.skeleton).value()[body::Landmark::kLeftWrist];
  motion.skeleton.joints[static_cast<std::size_t>(wrist)].offset_m *= 1e6;
  const std::string path = testing::TempDir() + "long_bone.bvh";
  std::string text = motion::WriteBvh(motion);
  std::ofstream(path) << text;
  const auto read = LoadMotion(path);
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.error().kind, ErrorKind::kInvalidData);
  EXPECT_THAT(read.error().message,
              HasSubstr("joint " + motion.skeleton.joint(wrist).name + " is"));
  EXPECT_THAT(read.error().message, HasSubstr("no person has such a bone"));
  text.insert(text.find("OFFSET", text.find("JOINT")) + 6, " 1e30");
  std::ofstream(path) << text;
  const auto huge = LoadMotion(path);
  ASSERT_FALSE(huge.ok());
  EXPECT_THAT(huge.error().message, HasSubstr("expected a number of OFFSET within +-1e9"));
}

/// A walker with a bent knee and a twisted trunk, whose file has z up: its rest pose stands along z
/// too, or it is the root alone that stands the person up.
std::string ZUpFile(motion::Motion motion, bool with_rest, const char* name) {
  const std::string path = testing::TempDir() + name;
  const Eigen::Matrix3d turn = body::AxisRotation(body::Axis::kY, kPi / 2);  // W's z to its x.
  for (body::Joint& joint : motion.skeleton.joints) {
    if (!with_rest) break;
    joint.offset_m = turn * joint.offset_m;
    joint.axes = turn * joint.axes;
    joint.plain_axes = false;  // WriteBvh() turns them into plain ones.
  }
  const body::Joint& root = motion.skeleton.joint(0);
  for (Eigen::Index i = 0; i < motion.frames(); ++i) {
    Eigen::VectorXd q = motion.q.col(i);
    q.head<3>() = turn * Eigen::Vector3d(q.head<3>());
    if (!with_rest) body::SetJointRotation(root, turn * body::JointRotation(root, q), q);
    motion.q.col(i) = q;
  }
  std::ofstream(path) << motion::WriteBvh(motion);
  return path;
}

TEST(Load, APersonWhoStandsAlongZOfABvhFileIsStoodUp) {
  motion::Motion motion{body::StandardPerson(1.75), 60, 0, {}};
  motion.q = Eigen::MatrixXd::Zero(motion.skeleton.dof, 20);
  for (Eigen::Index i = 0; i < motion.frames(); ++i) {
    for (int dof = 3; dof < motion.skeleton.dof; ++dof) {
      motion.q(dof, i) = 0.2 * std::sin(0.1 * static_cast<double>(i) + dof);
    }
    motion.q(0, i) = 0.02 * static_cast<double>(i);
  }
  motion.q.row(2).setConstant(0.95);
  body::Kinematics truth(motion.skeleton);
  for (const bool with_rest : {true, false}) {
    const auto read = LoadMotion(ZUpFile(motion, with_rest, "z_up.bvh"));
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_THAT(read->note, HasSubstr("z taken for up"));
    body::Kinematics at(read->motion.skeleton);
    for (const Eigen::Index frame : {0, 19}) {
      body::ComputeKinematics(motion.skeleton, motion.q.col(frame), truth);
      body::ComputeKinematics(read->motion.skeleton, read->motion.q.col(frame), at);
      for (int joint = 0; joint < motion.skeleton.size(); ++joint) {
        const int same = body::FindJoint(read->motion.skeleton, motion.skeleton.joint(joint).name);
        if (same < 0) continue;  // An end point, which BVH gives another name.
        EXPECT_LT(
            (at.p_WJ[static_cast<std::size_t>(same)] - truth.p_WJ[static_cast<std::size_t>(joint)])
                .norm(),
            1e-4)
            << motion.skeleton.joint(joint).name << " with_rest " << with_rest;
      }
    }
  }
}

TEST(Load, APersonWhoLiesIsLeftLyingWithANote) {
  motion::Motion motion{body::StandardPerson(1.75), 60, 0, {}};
  motion.q = Eigen::MatrixXd::Zero(motion.skeleton.dof, 20);
  motion.q.row(0).setConstant(3);
  motion.q.row(2).setConstant(0.1);
  const body::Joint& root = motion.skeleton.joint(0);
  for (Eigen::Index i = 0; i < motion.frames(); ++i) {
    Eigen::VectorXd q = motion.q.col(i);
    body::SetJointRotation(root, body::AxisRotation(body::Axis::kY, kPi / 2), q);
    motion.q.col(i) = q;
  }
  const std::string path = testing::TempDir() + "lies.bvh";
  std::ofstream(path) << motion::WriteBvh(motion);
  const auto read = LoadMotion(path);
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_THAT(read->note, HasSubstr("the person lies or hangs"));
  EXPECT_NEAR(read->motion.q(2, 5), 0.1, 1e-6);
}

TEST(Load, CapitalsInTheUnitOfAC3dFileAreRead) {
  if (Shared().empty()) GTEST_SKIP() << "needs FOOTING_TEST_DATA";
  const auto read = LoadMotion(Shared() + "/forces/vua_stoop/stoop1_t169_f620f800.c3d");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_NEAR(read->height_m.value_or(0), 1.8, 0.15);
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
