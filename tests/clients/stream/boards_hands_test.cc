#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <set>

#include "clients/stream/feeds.h"
#include "clients/stream/rendered_hands.h"
#include "common/body/kinematics.h"
#include "common/body/points.h"
#include "common/frames/netpbm.h"
#include "common/camera/find.h"
#include "tests/clients/stream/boards_fixture.h"
#include "tests/clients/stream/made_stage.h"

namespace footing::stream_client {
namespace {

using testing::HasSubstr;

TEST_F(BoardsTest, MovesAreForACamera) {
  options_.moves = true;
  EXPECT_THAT(PlanBoards(options_, {}).error().message, HasSubstr("--moves needs --hands camera"));
}

TEST_F(BoardsTest, ACameraSeesTheSpheresInTheFists) {
  options_.hands = "camera";
  EXPECT_THAT(PlanBoards(options_, {}).error().message, HasSubstr("--frames-to"));
  options_.camera_file = folder_.Path("camera.json");
  options_.frames_to = folder_.Path("frames");
  std::ofstream(options_.camera_file) << DemoCameraFile();
  ASSERT_EQ(::mkfifo(options_.frames_to.c_str(), 0600), 0);
  // Its reader, ready before the writer opens.
  const int reader = ::open(options_.frames_to.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  auto plan = PlanBoards(options_, {});
  ASSERT_TRUE(plan) << plan.error().message;
  ASSERT_EQ(plan->feeds.size(), 2u);
  constexpr double kT_s = 2;
  constexpr std::int64_t kExposedNs = 123'456'789;
  plan->feeds[1].frames(kT_s, kExposedNs, {});
  frames::NetpbmReader images;
  std::optional<frames::Frame> frame;
  std::array<char, 65536> buffer;
  ::fcntl(reader, F_SETFL, 0);  // Waits from here on.
  while (!frame) {
    const ssize_t count = ::read(reader, buffer.data(), buffer.size());
    ASSERT_GT(count, 0);
    images.Add({buffer.data(), static_cast<std::size_t>(count)});
    auto next = images.Next();
    ASSERT_TRUE(next);
    frame = *next;
  }
  ::close(reader);
  EXPECT_EQ(frame->time_ns, kExposedNs);
  const auto camera = *frames::ParseCameraFile(DemoCameraFile(), "demo");
  sphere::Finder finder(camera.lens, camera.Targets(), camera.settings);
  const auto found = finder.Find(frame->View());
  const auto stage = MadeStage(options_.stage);
  for (int side : {0, 1}) {
    ASSERT_TRUE(found[static_cast<std::size_t>(side)]);
    const Eigen::Vector3d p_W_m = *camera.X_WC * found[static_cast<std::size_t>(side)]->p_C_m;
    // Depth to some 5 mm at 2 m, and up to 8 ms of a hand's motion from row to row.
    EXPECT_LT((p_W_m - FistAt(*stage, side, kT_s)).norm(), 0.04) << side;
  }
}

TEST_F(BoardsTest, ALostHandIsASilentWiimoteOrAPointThatIsNotSeen) {
  options_.lost_hand = "right";
  options_.lost_from_s = 2;
  options_.lost_for_s = 1;
  options_.hands = "wiimote";
  const auto held = PlanBoards(options_, {});
  ASSERT_TRUE(held && held->silences.size() == 1);
  const Silence& silence = held->silences[0];
  EXPECT_EQ(held->devices[silence.device].role(), stream::DeviceRole::kRightHand);
  EXPECT_FALSE(silence.Covers(1.99));
  EXPECT_TRUE(silence.Covers(2.99));
  EXPECT_FALSE(silence.Covers(3));
  options_.hands = "kinect";
  auto seen = PlanBoards(options_, {});
  ASSERT_TRUE(seen);
  EXPECT_TRUE(seen->silences.empty());
  Feed& kinect = seen->feeds[0];
  EXPECT_NEAR(kinect.rate_hz, 30, 1e-9);
  EXPECT_NEAR(kinect.late_s, 2.0 / 30, 1e-9);
  EXPECT_EQ(kinect.hands(1.9).points.size(), 15u);
  ASSERT_EQ(kinect.hands(2.5).points.size(), 14u);
  EXPECT_EQ(kinect.hands(2.6).points[0].role, stream::DeviceRole::kLeftHand);
  EXPECT_EQ(kinect.hands(3.1).points.size(), 15u);
}

TEST_F(BoardsTest, AKinectSendsEachJointOnceAndSaysWhatIsHidden) {
  options_.hands = "kinect";
  auto plan = PlanBoards(options_, {});
  ASSERT_TRUE(plan);
  const stream::HandFrame frame = plan->feeds[0].hands(0);
  ASSERT_EQ(frame.points.size(), 15u);
  std::set<stream::BodyJoint> joints;
  for (const stream::TrackedPoint& point : frame.points) {
    const bool is_hand = point.role != stream::DeviceRole::kUnspecified;
    EXPECT_NE(is_hand, point.joint != stream::BodyJoint::kUnspecified);
    if (!is_hand) joints.insert(point.joint);
    EXPECT_EQ(point.occluded, point.confidence < 0.75);
  }
  EXPECT_EQ(joints.size(), stream::kBodyJoints);
}

TEST_F(BoardsTest, ACapsSphereIsAboveTheHead) {
  options_.head = "sphere";
  options_.hand_noise_m = 0;
  auto plan = PlanBoards(options_, {});
  ASSERT_TRUE(plan);
  const stream::HandFrame frame = plan->feeds.back().hands(0);
  ASSERT_EQ(frame.points.size(), 1u);
  EXPECT_EQ(frame.points[0].joint, stream::BodyJoint::kHead);
  options_.hands = "kinect";
  options_.head = "none";
  auto kinect = PlanBoards(options_, {});
  Eigen::Vector3d head_m = Eigen::Vector3d::Zero();
  for (const stream::TrackedPoint& point : kinect->feeds[0].hands(0).points) {
    if (point.joint == stream::BodyJoint::kHead) head_m = point.position_m;
  }
  EXPECT_NEAR(frame.points[0].position_m.z() - head_m.z(), 0.12, 0.08) << "Kinects err";
  options_.head = "hat";
  EXPECT_THAT(PlanBoards(options_, {}).error().message, HasSubstr("none or sphere"));
}

TEST_F(BoardsTest, HandsAreSeenWhereTheFistsAreWithTheNoiseAskedFor) {
  const auto stage = MadeStage(options_.stage);
  const Feed feed = HandFeed(stage, 0.02, 7);
  Feed first = feed, second = feed;
  double square = 0;
  body::Kinematics at(stage->scene.body.skeleton);
  body::ComputeKinematics(stage->scene.body.skeleton, stage->scene.motion.q.col(0), at);
  constexpr int kFrames = 2000;
  for (int i = 0; i < kFrames; ++i) {
    const stream::HandFrame frame = first.hands(0);
    ASSERT_EQ(frame.points.size(), 2u);
    EXPECT_TRUE(frame.simulated);
    EXPECT_EQ(frame.points[0].role, stream::DeviceRole::kLeftHand);
    EXPECT_EQ(frame.points[0].sd_m, Eigen::Vector3d::Constant(0.02));
    if (i == 0) {
      EXPECT_EQ(second.hands(0).points[1].position_m, frame.points[1].position_m);
    }
    for (const int side : {0, 1}) {
      const body::Point fist = body::Fist(stage->scene.body, side);
      const auto joint = static_cast<std::size_t>(fist.joint);
      square += (frame.points[static_cast<std::size_t>(side)].position_m -
                 body::Place(fist, at.R_WJ[joint], at.p_WJ[joint]))
                    .squaredNorm();
    }
  }
  EXPECT_NEAR(std::sqrt(square / (6 * kFrames)), 0.02, 0.0006);
}

}  // namespace
}  // namespace footing::stream_client
