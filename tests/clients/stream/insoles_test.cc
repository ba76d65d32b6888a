#include "clients/stream/insoles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <memory>

#include "common/base/units.h"
#include "common/virtual/devices/insole_cells.h"
#include "tests/clients/stream/made_stage.h"
#include "tests/common/temporary_folder.h"

namespace footing::stream_client {
namespace {

using testing::HasSubstr;

class InsolesTest : public testing::Test {
 protected:
  InsolesTest() {
    std::ofstream(path_) << R"({"keys": [{"seconds": 1.5}, {"seconds": 0.7, "weight": 0.5},
        {"seconds": 0.7, "weight": 0}, {"seconds": 1}]})";
    options_.stage.motion = path_;
    options_.stage.mass_kg = 60;
  }

  const test::TemporaryFolder folder_;
  const std::string path_ = folder_.Path("script.json");
  InsolesOptions options_;
};

TEST_F(InsolesTest, BothInsolesAndTheTruePoseAreToldAndNoDeviceIsThere) {
  auto plan = PlanInsoles(options_, {});
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_TRUE(plan->devices.empty());
  ASSERT_EQ(plan->feeds.size(), 3u);
  EXPECT_EQ(plan->feeds[0].contacts(0).body, stream::ContactBody::kLeftFoot);
  EXPECT_EQ(plan->feeds[1].contacts(0).body, stream::ContactBody::kRightFoot);
  EXPECT_TRUE(plan->feeds[2].reference);
  options_.hands = "move";
  EXPECT_EQ(PlanInsoles(options_, {})->feeds.size(), 4u);
  options_.hands = "wiimote";
  EXPECT_THAT(PlanInsoles(options_, {}).error().message, HasSubstr("none and move"));
}

TEST_F(InsolesTest, TheCellsCarryTheFootsLoadAtItsCop) {
  options_.stage.on_boards = false;
  const auto stage = MadeStage(options_.stage);
  for (const std::size_t foot : {0u, 1u}) {
    Feed feed = InsoleFeed(stage, foot, {}, 1);
    for (double t_s = 0.05; t_s < stage->duration_s(); t_s += 0.31) {
      const stream::ContactFrame frame = feed.contacts(t_s);
      EXPECT_TRUE(frame.simulated);
      double total_n = 0;
      Eigen::Vector3d moment = Eigen::Vector3d::Zero();
      for (const stream::ContactCell& cell : frame.cells) {
        total_n += cell.load_n;
        moment += cell.load_n * cell.position_m;
      }
      const auto truth = stage->FootAt(foot, t_s);
      EXPECT_NEAR(total_n, truth.load_n, 1e-6) << t_s;
      const auto sole = virtual_sensors::PlaceOfSole(stage->scene.course, foot, 0);
      const Eigen::Vector2d off = truth.cop_m - sole.heel_m;
      const double ahead_m = std::cos(sole.yaw_rad) * off.x() + std::sin(sole.yaw_rad) * off.y();
      EXPECT_NEAR(moment.x() / total_n, ahead_m, 0.005) << t_s;
    }
  }
}

TEST_F(InsolesTest, NoiseAndGainsAreAsAskedForAndTheSameForASeed) {
  options_.stage.on_boards = false;
  const auto stage = MadeStage(options_.stage);
  Feed exact = InsoleFeed(stage, 0, {}, 1);
  Feed noisy = InsoleFeed(stage, 0, {0.1, 0}, 5);
  Feed again = InsoleFeed(stage, 0, {0.1, 0}, 5);
  double square = 0;
  constexpr int kFrames = 500;
  const stream::ContactFrame truth = exact.contacts(0);
  for (int i = 0; i < kFrames; ++i) {
    const stream::ContactFrame frame = noisy.contacts(0), same = again.contacts(0);
    for (std::size_t k = 0; k < frame.cells.size(); ++k) {
      square += std::pow(frame.cells[k].load_n - truth.cells[k].load_n, 2);
      ASSERT_EQ(frame.cells[k].load_n, same.cells[k].load_n);
    }
  }
  const double count = kFrames * static_cast<double>(truth.cells.size());
  EXPECT_NEAR(std::sqrt(square / count), KilogramsToNewtons(0.1), 0.03);
  Feed spread = InsoleFeed(stage, 0, {0, 0.05}, 5);
  const stream::ContactFrame read = spread.contacts(0);
  EXPECT_GT(std::abs(read.cells[0].load_n / truth.cells[0].load_n -
                     read.cells[1].load_n / truth.cells[1].load_n),
            1e-4);
}

}  // namespace
}  // namespace footing::stream_client
