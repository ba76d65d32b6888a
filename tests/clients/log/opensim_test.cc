#include "clients/log/opensim.h"

#include <gtest/gtest.h>

#include <vector>

namespace footing::log_client {
namespace {

using Eigen::Vector3d;

TEST(ForceTable, IsReadAgainAsTheForcesOfTwoPlates) {
  std::vector<FootForces> forces(3);
  forces[1][0] = {300, {0.1, 0.2, 0.05}};
  forces[1][1] = {400, {0.15, -0.2, 0.05}};
  // Through the file and back, by the reader of --boards forces.
  motion::Table table = ForceTable(forces, 120);
  table.name = "pose_1_grf.mot";
  const auto parsed = motion::ParseTable(motion::WriteTable(table), "pose_1_grf.mot");
  ASSERT_TRUE(parsed.ok()) << parsed.error().message;
  EXPECT_FALSE(parsed->in_degrees);
  const auto read = motion::ToGroundForces(*parsed, "pose_1_grf.mot");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_NEAR(read->rate_hz, 120, 1e-3);
  EXPECT_EQ(read->start_s, 0);
  ASSERT_EQ(read->plates.size(), 2U);
  const motion::PlateForces& right = read->plates[0];
  const motion::PlateForces& left = read->plates[1];
  EXPECT_EQ(right.name, "ground_force_r_");
  EXPECT_LT((right.force_W.col(1) - Vector3d(0, 0, 400)).norm(), 1e-12);
  EXPECT_LT((left.force_W.col(1) - Vector3d(0, 0, 300)).norm(), 1e-12);
  EXPECT_LT((left.cop_W.col(1) - Vector3d(0.1, 0.2, 0.05)).norm(), 1e-12);
  EXPECT_EQ(left.force_W.col(2), Vector3d::Zero());
}

}  // namespace
}  // namespace footing::log_client
