#include "clients/log/c3d_body.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "common/body/skeleton.h"

namespace footing::log_client {
namespace {

using Eigen::Vector3d;

/// A root that moves ahead by 1 cm a frame, 1 m above the floor, and a joint half a metre above it.
motion::Motion Column(Eigen::Index frames) {
  body::Joint root, top;
  root.name = "root";
  root.rotations = {{body::Axis::kZ}, {body::Axis::kX}, {body::Axis::kY}};
  top.name = "top";
  top.parent = 0;
  top.offset_m = {0, 0, 0.5};
  motion::Motion motion;
  motion.skeleton = body::MakeSkeleton({root, top});
  motion.rate_hz = 100;
  motion.q.setZero(motion.skeleton.dof, frames);
  for (Eigen::Index i = 0; i < frames; ++i) {
    motion.q.col(i).head<3>() << 0.01 * static_cast<double>(i), 0.2, 1;
  }
  return motion;
}

motion::C3d ThroughAFile(const motion::C3d& c3d) {
  const auto bytes = motion::WriteC3d(c3d);
  EXPECT_TRUE(bytes.ok()) << bytes.error().message;
  const auto read = motion::ParseC3d(std::vector<std::uint8_t>(bytes->begin(), bytes->end()), "x");
  EXPECT_TRUE(read.ok()) << read.error().message;
  return *read;
}

TEST(C3dBody, ItsPointsAreTheJoints) {
  const motion::C3d read =
      ThroughAFile(ToC3d(Column(3), std::vector<bool>(3, true), std::vector<FootForces>(3)));
  EXPECT_EQ(read.points.names, (std::vector<std::string>{"root", "top"}));
  EXPECT_EQ(read.y_screen, "+Z");
  EXPECT_LT((read.points.p[0].col(2) - Vector3d(0.02, 0.2, 1)).norm(), 1e-6);
  EXPECT_LT((read.points.p[1].col(2) - Vector3d(0.02, 0.2, 1.5)).norm(), 1e-6);
}

TEST(C3dBody, APoseThatIsNotValidHasInvalidPoints) {
  const motion::C3d c3d = ToC3d(Column(3), {true, false, true}, std::vector<FootForces>(3));
  const auto bytes = motion::WriteC3d(c3d);
  ASSERT_TRUE(bytes.ok()) << bytes.error().message;
  // After the parameters: per frame two points of four floats, then twelve analog values.
  const std::size_t data = 512 * (static_cast<std::uint8_t>((*bytes)[16]) - 1U);
  for (std::size_t frame = 0; frame < 3; ++frame) {
    for (std::size_t point = 0; point < 2; ++point) {
      float residual = 0;
      std::memcpy(&residual, bytes->data() + data + 80 * frame + 16 * point + 12, 4);
      EXPECT_EQ(residual, frame == 1 ? -1 : 0) << frame << " " << point;
    }
  }
  const motion::C3d read = ThroughAFile(c3d);
  EXPECT_TRUE(motion::Seen(read.points.p[0].col(0)));
  EXPECT_FALSE(motion::Seen(read.points.p[0].col(1)));
  EXPECT_FALSE(motion::Seen(read.points.p[1].col(1)));
}

TEST(C3dBody, ItsPlatesCarryTheFeet) {
  std::vector<FootForces> forces(3);
  forces[1] = {{{300, {0.13, 0.21, 0}}, {450, {0.05, -0.18, 0}}}};
  forces[2] = {{{0, {9, 9, 0}}, {700, {-0.02, -0.2, 0}}}};  // The left foot is in the air.
  const motion::C3d read = ThroughAFile(ToC3d(Column(3), std::vector<bool>(3, true), forces));
  EXPECT_EQ(read.analog_names[2], "Fz1");
  const auto plates = motion::ToGroundForces(read, "x.c3d");
  ASSERT_TRUE(plates.ok()) << plates.error().message;
  EXPECT_EQ(plates->rate_hz, 100);
  ASSERT_EQ(plates->plates.size(), 2u);
  for (std::size_t foot = 0; foot < 2; ++foot) {
    const motion::PlateForces& plate = plates->plates[foot];
    for (std::size_t i = 0; i < 3; ++i) {
      const FootForce& one = forces[i][foot];
      const auto column = static_cast<Eigen::Index>(i);
      EXPECT_LT((plate.force_W.col(column) - Vector3d(0, 0, one.load_n)).norm(), 1e-3);
      if (one.load_n > 0) {
        EXPECT_LT((plate.cop_W.col(column) - one.cop_W).norm(), 1e-6);
      }
      EXPECT_LT(plate.moment_W.col(column).norm(), 1e-3);
    }
  }
  // The rectangle holds the loaded feet, and is no larger than a grid of 10 cm makes it.
  const auto& corners = read.plates[0].corners;
  EXPECT_LT((corners.rowwise().minCoeff() - Vector3d(-0.1, -0.3, 0)).norm(), 1e-6);
  EXPECT_LT((corners.rowwise().maxCoeff() - Vector3d(0.2, 0.3, 0)).norm(), 1e-6);
}

}  // namespace
}  // namespace footing::log_client
