#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <set>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "clients/stream/boards.h"
#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/camera/find.h"
#include "common/frames/camera_file.h"
#include "common/virtual/devices/board_cells.h"
#include "tests/clients/stream/boards_fixture.h"
#include "tests/clients/stream/made_stage.h"
#include "tests/common/temporary_folder.h"

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
    const Eigen::Vector3d fist_W_m = PlaceAt(*stage, body::Fist(stage->scene.body, side), kT_s);
    EXPECT_LT((p_W_m - fist_W_m).norm(), 0.04) << side;
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

TEST_F(BoardsTest, TwoBoardsAndTheTruePoseAreThereAndHandsWhenAskedFor) {
  auto plan = PlanBoards(options_, {});
  ASSERT_TRUE(plan) << plan.error().message;
  ASSERT_EQ(plan->devices.size(), 2u);
  EXPECT_EQ(plan->devices[0].role(), stream::DeviceRole::kLeftBoard);
  EXPECT_EQ(plan->devices[1].role(), stream::DeviceRole::kRightBoard);
  ASSERT_EQ(plan->feeds.size(), 1u);
  EXPECT_TRUE(plan->feeds[0].reference);
  EXPECT_EQ(plan->duration_s, 0);  // A script again and again.
  options_.hands = "move";
  EXPECT_EQ(PlanBoards(options_, {})->feeds.size(), 2u);
  options_.hands = "wiimote";
  EXPECT_EQ(PlanBoards(options_, {})->devices.size(), 4u);
  options_.hands = "straps";
  const auto strapped = PlanBoards(options_, {});
  ASSERT_EQ(strapped->devices.size(), 6u);
  EXPECT_EQ(strapped->devices[2].role(), stream::DeviceRole::kLeftUpperArm);
  EXPECT_EQ(strapped->devices[5].role(), stream::DeviceRole::kRightForearm);
}

TEST_F(BoardsTest, WhatIsNotThereIsAUsageErrorThatListsWhatIs) {
  options_.hands = "leap";
  EXPECT_THAT(PlanBoards(options_, {}).error().message,
              HasSubstr("none, move, wiimote, straps, kinect, camera"));
  options_.hands = "move";
  options_.lost_hand = "middle";
  EXPECT_THAT(PlanBoards(options_, {}).error().message, HasSubstr("left or right"));
  options_.hands = "none";
  options_.lost_hand = "left";
  EXPECT_THAT(PlanBoards(options_, {}).error().message, HasSubstr("nothing to lose"));
  options_.lost_hand = "";
  options_.stage.motion = "dance";
  const auto unknown = PlanBoards(options_, {});
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(unknown.error().message, HasSubstr("demo own_motion quiet"));
  options_.stage.motion = "/nonexistent/walk.bvh";
  EXPECT_THAT(PlanBoards(options_, {}).error().message, HasSubstr("/nonexistent/walk.bvh"));
}

TEST_F(BoardsTest, TheBoardsTotalAndCopAreThoseOfTheMotion) {
  const auto stage = MadeStage(options_.stage);
  const auto& scene = stage->scene;
  for (double t_s = 0.05; t_s < stage->duration_s(); t_s += 0.0917) {
    double total_n = 0;
    Eigen::Vector2d moment = Eigen::Vector2d::Zero();
    for (std::size_t f = 0; f < 2; ++f) {
      const auto load = virtual_sensors::LoadBoard(stage->boards[f], stage->FootAt(f, t_s));
      const auto places = virtual_sensors::SensorPlaces(stage->boards[f]);
      for (std::size_t k = 0; k < 4; ++k) {
        total_n += load.corners_n[k];
        moment += load.corners_n[k] * places[k];
      }
    }
    const auto at = stage->At(t_s);
    const auto between = [&](const auto& columns) {
      return ((1 - at.share) * columns.col(at.frame) + at.share * columns.col(at.frame + 1)).eval();
    };
    EXPECT_NEAR(total_n, between(scene.reaction.force_n).z(), 1e-6) << t_s;
    EXPECT_LT((moment / total_n - between(scene.reaction.cop_m)).norm(), 0.002) << t_s;
  }
  EXPECT_EQ(stage->outside_share, 0);
}

TEST_F(BoardsTest, AScriptGoesOnAndARecordingStaysAtItsEnd) {
  Stage stage = *MadeStage(options_.stage);
  const double end_s = stage.duration_s();
  EXPECT_EQ(stage.At(end_s + 0.305).frame, stage.At(0.305).frame);
  stage.repeats = false;
  EXPECT_EQ(stage.At(end_s + 0.3).frame, stage.scene.motion.frames() - 2);
  EXPECT_EQ(stage.At(end_s + 0.3).share, 1);
  EXPECT_EQ(stage.At(-1).frame, 0);
}

TEST_F(BoardsTest, AScriptThatDoesNotEndInTheTPoseIsPerformedOnce) {
  EXPECT_TRUE(MadeStage(options_.stage)->repeats);
  std::ofstream(path_) << R"({"keys": [{"seconds": 1}, {"seconds": 1, "crouch_m": 0.2}]})";
  EXPECT_FALSE(MadeStage(options_.stage)->repeats);
}

TEST_F(BoardsTest, BoardsLaidUnderWideFeetLieFurtherApart) {
  std::ofstream(path_) << R"({"keys": [{"seconds": 0.5}, {"seconds": 0.8, "weight": -1},
      {"seconds": 0.6, "left_out_m": 0.22}, {"seconds": 0.8, "weight": 1},
      {"seconds": 0.6, "right_out_m": 0.22}, {"seconds": 0.8, "weight": 0}, {"seconds": 9}]})";
  const auto as_always = MadeStage(options_.stage);
  options_.stage.place_boards = true;
  const auto placed = MadeStage(options_.stage);
  EXPECT_DOUBLE_EQ(as_always->gap_m, 0.02);
  EXPECT_GT(as_always->outside_share, 0.5);
  EXPECT_GT(placed->gap_m, 0.05);
  EXPECT_LT(placed->outside_share, 0.3);
  EXPECT_DOUBLE_EQ(placed->boards[0].middle_m.y(), 0.5 * (0.316 + placed->gap_m));
}

TEST_F(BoardsTest, TheReferenceIsTheWholePoseAndFitsIntoAMessage) {
  const auto stage = MadeStage(options_.stage);
  const stream::ReferenceFrame frame = PoseFeed(stage).reference(3.02);
  const auto& skeleton = stage->scene.body.skeleton;
  ASSERT_EQ(static_cast<int>(frame.parents.size()), skeleton.size());
  EXPECT_LE(frame.parents.size(), 64u);
  body::Kinematics at(skeleton);
  body::ComputeKinematics(skeleton, stage->scene.motion.q.col(302), at);
  for (std::size_t i = 0; i < frame.parents.size(); ++i) {
    EXPECT_EQ(frame.parents[i], skeleton.joint(static_cast<int>(i)).parent);
    EXPECT_LT((frame.positions_m[i] - at.p_WJ[i]).norm(), 1e-6);
  }
  EXPECT_LT((frame.com_m - body::CentreOfMass(stage->scene.body, at)).norm(), 1e-6);
}

TEST(ShownJoints, OfALargeSkeletonAreThoseOnTheWayToALandmark) {
  body::Body body = *body::MakeBody(body::StandardPerson(1.75), {});
  EXPECT_EQ(static_cast<int>(ShownJoints(body).size()), body.skeleton.size());
  std::vector<body::Joint> joints = body.skeleton.joints;
  for (int i = 0; i < 60; ++i) {
    joints.push_back({});
    joints.back().name = "finger";
    joints.back().parent = body.landmarks[body::Landmark::kLeftWrist];
  }
  body.skeleton = body::MakeSkeleton(std::move(joints));
  const auto shown = ShownJoints(body);
  EXPECT_LE(shown.size(), 64u);
  for (const int landmark : body.landmarks.joint) {
    if (landmark >= 0) {
      EXPECT_THAT(shown, testing::Contains(landmark));
    }
  }
}

TEST_F(BoardsTest, AWiimoteInTheFistFeelsGravityAndTurnsWithTheArm) {
  const auto stage = MadeStage(options_.stage);
  constexpr int kDevices = 8;
  double felt_mps2 = 0;
  for (int device = 0; device < kDevices; ++device) {
    const int side = device % 2;
    SimulatedDevice::WiimoteMotion motion = InFist(stage, side, static_cast<std::uint64_t>(device));
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), turned = Eigen::Vector3d::Zero();
    Eigen::Vector3d bias = Eigen::Vector3d::Zero();
    for (int i = 0; i < 270; ++i) {
      const auto felt = motion(0.01 * i);
      if (i < 100) force += 0.01 * felt.specific_force_S_mps2;
      if (i < 100) bias += 0.01 * felt.angular_velocity_S_radps;
      if (i >= 100) turned += 0.01 * (felt.angular_velocity_S_radps - bias);
    }
    felt_mps2 += force.norm() / kDevices;
    // T-pose, buttons up: z of a Wiimote is down; it lies up to 3 x 0.17 rad off.
    EXPECT_LT(force.z(), -kStandardGravityMps2 * std::cos(0.51)) << device;
    // The arm comes down by 80 degrees about the axis ahead, which is the Wiimote's y.
    EXPECT_GT((side == 0 ? -1 : 1) * turned.y(), 80 * kPi / 180 * std::cos(0.51)) << device;
    EXPECT_NEAR(turned.norm(), 80 * kPi / 180, 0.1) << device;
  }
  // 1 % of gain and 0.1 m/s2 of bias: 0.14 for a device, 0.05 for the mean of eight.
  EXPECT_NEAR(felt_mps2, kStandardGravityMps2, 0.15);
}

TEST_F(BoardsTest, ACopyOfAWiimotesMotionBeginsAnew) {
  const SimulatedDevice::WiimoteMotion motion = InFist(MadeStage(options_.stage), 0, 5);
  SimulatedDevice::WiimoteMotion one = motion, other = motion;
  for (int i = 0; i < 5; ++i) one(0.01 * i);
  EXPECT_NE(one(0.05).specific_force_S_mps2, other(0.05).specific_force_S_mps2);
  SimulatedDevice::WiimoteMotion first = motion, again = motion;
  EXPECT_EQ(first(0.1).specific_force_S_mps2, again(0.1).specific_force_S_mps2);
}

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
