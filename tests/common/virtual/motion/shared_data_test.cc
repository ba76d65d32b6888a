#include "tests/common/virtual/motion/shared_data.h"

#include <gtest/gtest.h>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/virtual/motion/asf.h"
#include "common/virtual/motion/bvh.h"
#include "common/virtual/motion/c3d.h"
#include "common/virtual/motion/table.h"
#include "common/virtual/motion/trc.h"

namespace footing::motion {
namespace {

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
