#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "clients/log/export_bodies.h"
#include "common/body/kinematics.h"
#include "common/body/skeleton.h"
#include "common/recording/recording_writer.h"
#include "common/virtual/motion/bvh.h"
#include "common/virtual/motion/table.h"
#include "common/wire/wire.h"
#include "tests/clients/log/temporary_folder.h"
#include "tests/common/temporary_folder.h"

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
  const motion::C3d read = ThroughAFile(
      ToC3d(Column(3), std::vector<bool>(3, true), std::vector<motion::FootForces>(3)));
  EXPECT_EQ(read.points.names, (std::vector<std::string>{"root", "top"}));
  EXPECT_EQ(read.y_screen, "+Z");
  EXPECT_LT((read.points.p[0].col(2) - Vector3d(0.02, 0.2, 1)).norm(), 1e-6);
  EXPECT_LT((read.points.p[1].col(2) - Vector3d(0.02, 0.2, 1.5)).norm(), 1e-6);
}

TEST(C3dBody, APoseThatIsNotValidHasInvalidPoints) {
  const motion::C3d c3d = ToC3d(Column(3), {true, false, true}, std::vector<motion::FootForces>(3));
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
  std::vector<motion::FootForces> forces(3);
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
      const motion::FootForce& one = forces[i][foot];
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

/// A chain of three links: root, a joint 0.5 m above it, and an end another 0.5 m on.
v1::Skeleton Chain() {
  v1::Skeleton skeleton;
  int parent = -1;
  for (const char* name : {"root", "spine", "top"}) {
    v1::Link& link = *skeleton.add_links();
    link.set_name(name);
    link.set_parent(parent++);
  }
  return skeleton;
}

v1::CharacterFrame FrameAt(double time_s, double bend_rad, bool calibrated = true) {
  v1::CharacterFrame frame;
  frame.set_time_s(time_s);
  v1::Character& character = *frame.add_characters();
  character.set_valid(calibrated);
  character.mutable_body()->set_calibrated(calibrated);
  character.mutable_body()->set_subject("p07");
  const Eigen::Quaterniond upright = Eigen::Quaterniond::Identity();
  const Eigen::Quaterniond bent(Eigen::AngleAxisd(bend_rad, Eigen::Vector3d::UnitY()));
  const Eigen::Vector3d root(0.1 * time_s, 0, 1), spine = root + Eigen::Vector3d(0, 0, 0.5);
  const Eigen::Vector3d top = spine + bent * Eigen::Vector3d(0, 0, 0.5);
  *character.add_links() = wire::ToProto(stream::LinkPose{root, upright});
  *character.add_links() = wire::ToProto(stream::LinkPose{spine, bent});
  *character.add_links() = wire::ToProto(stream::LinkPose{top, bent});
  return frame;
}

TEST(MotionGatherer, TheMotionHasEveryLinkWhereItWas) {
  MotionGatherer gatherer(Chain());
  for (int i = 0; i < 60; ++i) gatherer.Add(FrameAt(i / 120.0, 0.02 * i));
  const auto motion = gatherer.Finish();
  ASSERT_TRUE(motion.ok()) << motion.error().message;
  EXPECT_NEAR(motion->rate_hz, 120, 1e-6);
  ASSERT_EQ(motion->frames(), 60);
  EXPECT_EQ(gatherer.subject(), "p07");
  // Through the file and back.
  const auto read = motion::ParseBvh(motion::WriteBvh(*motion), "made.bvh");
  ASSERT_TRUE(read.ok()) << read.error().message;
  body::Kinematics at(read->skeleton);
  for (const int i : {0, 30, 59}) {
    body::ComputeKinematics(read->skeleton, read->q.col(i), at);
    const v1::CharacterFrame frame = FrameAt(i / 120.0, 0.02 * i);
    for (int link = 0; link < 3; ++link) {
      const Eigen::Vector3d true_m = wire::FromProto(frame.characters(0).links(link).position_m());
      EXPECT_NEAR((at.p_WJ[static_cast<std::size_t>(link)] - true_m).norm(), 0, 1e-4);
    }
  }
}

TEST(MotionGatherer, AMissingFrameKeepsThePoseBeforeAndTheTime) {
  MotionGatherer gatherer(Chain());
  for (const int i : {0, 1, 2, 4, 5}) gatherer.Add(FrameAt(i / 120.0, 0.1 * i));
  const auto motion = gatherer.Finish();
  ASSERT_TRUE(motion.ok());
  ASSERT_EQ(motion->frames(), 6);
  EXPECT_EQ(motion->q.col(3), motion->q.col(2));
  EXPECT_NE(motion->q.col(4), motion->q.col(3));
}

TEST(MotionGatherer, TheFrameThatCompletesTheTPoseIsLeftOut) {
  MotionGatherer gatherer(Chain());
  for (int i = 0; i < 4; ++i) {
    v1::CharacterFrame frame = FrameAt(i / 120.0, 0.1 * i);
    frame.mutable_characters(0)->set_valid(i > 0 && i != 2);
    gatherer.Add(frame, static_cast<std::uint64_t>(100 + i));
  }
  EXPECT_EQ(gatherer.begin_ns(), 101u);
  const auto motion = gatherer.Finish();
  ASSERT_TRUE(motion.ok());
  EXPECT_EQ(motion->frames(), 3) << "what is not valid later stays";
}

TEST(MotionGatherer, WithALagForcesAreThoseOfTheInstantOfThePose) {
  MotionGatherer gatherer(Chain());
  for (int i = 0; i < 60; ++i) {
    v1::CharacterFrame frame = FrameAt(i / 120.0, 0);
    v1::BodyState& body = *frame.mutable_characters(0)->mutable_body();
    body.set_lag_s(0.1);
    for (int side = 0; side < 2; ++side) {
      v1::BodyFoot& foot = *body.add_feet();
      foot.set_load_n(100 + i);
      foot.set_cop_valid(true);
    }
    gatherer.Add(frame);
  }
  const auto forces = gatherer.Forces();
  ASSERT_TRUE(forces.ok());
  ASSERT_EQ(forces->size(), 60u);
  EXPECT_EQ(gatherer.lag_s(), 0.1);
  EXPECT_EQ((*forces)[40][0].load_n, 100 + 40 - 12) << "the pose of row 40 is 12 frames old";
  EXPECT_EQ((*forces)[5][0].load_n, 100);
}

TEST(MotionGatherer, TheForcesStandBesideTheFramesOfTheMotion) {
  MotionGatherer gatherer(Chain());
  for (const int i : {0, 1, 2, 4, 5}) {
    v1::CharacterFrame frame = FrameAt(3 + i / 120.0, 0);
    v1::BodyState& body = *frame.mutable_characters(0)->mutable_body();
    for (const double load_n : {100.0 + i, 500.0}) {
      v1::BodyFoot& foot = *body.add_feet();
      foot.set_load_n(load_n);
      foot.set_cop_valid(i != 2);
      *foot.mutable_cop_m() = wire::ToProto(Eigen::Vector3d(0.1, 0.2, 0.05));
    }
    gatherer.Add(frame, 7'000'000'000 + static_cast<std::uint64_t>(i));
  }
  EXPECT_EQ(gatherer.begin_ns(), 7'000'000'000U);
  const auto forces = gatherer.Forces();
  ASSERT_TRUE(forces.ok()) << forces.error().message;
  std::vector<double> left_n;
  for (const motion::FootForces& feet : *forces) left_n.push_back(feet[0].load_n);
  EXPECT_EQ(left_n,
            (std::vector<double>{100, 101, 0, 0, 104, 105}));  // 2 has no COP, 3 is missing.
  EXPECT_EQ((*forces)[1][1].load_n, 500);
  EXPECT_EQ((*forces)[1][1].cop_W, Eigen::Vector3d(0.1, 0.2, 0.05));
}

/// A frame whose feet carry 300 and 400 N.
v1::CharacterFrame Standing(double time_s, bool left_measured, bool right_measured) {
  v1::CharacterFrame frame = FrameAt(time_s, 0);
  v1::BodyState& body = *frame.mutable_characters(0)->mutable_body();
  for (const double load_n : {300.0, 400.0}) {
    v1::BodyFoot& foot = *body.add_feet();
    foot.set_load_n(load_n);
    foot.set_cop_valid(true);
  }
  body.add_feet_told(left_measured);
  body.add_feet_told(right_measured);
  return frame;
}

TEST(MotionGatherer, WithoutBothBoardsTheLoadsAreOldAndNoForces) {
  MotionGatherer gatherer(Chain());
  gatherer.Add(Standing(0, true, true));
  gatherer.Add(Standing(0.1, false, true));
  gatherer.Add(Standing(0.2, false, false));
  v1::CharacterFrame insoles = Standing(0.3, false, true);
  insoles.mutable_characters(0)->mutable_body()->set_contact_source("insoles");
  gatherer.Add(insoles);
  const auto forces = gatherer.Forces();
  ASSERT_TRUE(forces.ok()) << forces.error().message;
  ASSERT_EQ(forces->size(), 4u);
  const std::vector<std::array<double, 2>> expected_n{{300, 400}, {0, 0}, {0, 0}, {0, 400}};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t side = 0; side < 2; ++side) {
      EXPECT_EQ((*forces)[i][side].load_n, expected_n[i][side]) << i << " " << side;
    }
  }
}

TEST(MotionGatherer, FramesAreValidAsTheEngineReportedThem) {
  MotionGatherer gatherer(Chain());
  for (const int i : {0, 1, 2, 4, 5}) {
    v1::CharacterFrame frame = FrameAt(i / 120.0, 0.1 * i);
    frame.mutable_characters(0)->set_valid(i != 2);
    gatherer.Add(frame);
  }
  const auto valid = gatherer.Valid();
  ASSERT_TRUE(valid.ok()) << valid.error().message;
  // Frame 3 is missing and repeats frame 2.
  EXPECT_EQ(*valid, (std::vector<bool>{true, true, false, false, true, true}));
}

TEST(JointPlaces, HaveAGapWhereThePoseIsNotValid) {
  MotionGatherer gatherer(Chain());
  for (int i = 0; i < 3; ++i) gatherer.Add(FrameAt(i / 120.0, 0));
  const auto motion = gatherer.Finish();
  ASSERT_TRUE(motion.ok()) << motion.error().message;
  const std::string text = motion::WriteTrc(JointPlaces(*motion, {true, false, true}), "a.trc");
  // Nine empty fields, and the tab after the last one.
  EXPECT_NE(text.find("2\t0.008333" + std::string(10, '\t') + "\n"), std::string::npos) << text;
  const auto read = motion::ParseTrc(text, "a.trc");
  ASSERT_TRUE(read.ok()) << read.error().message;
  ASSERT_EQ(read->frames(), 3);
  EXPECT_TRUE(motion::Seen(read->p[2].col(0)));
  for (const auto& track : read->p) EXPECT_FALSE(motion::Seen(track.col(1)));
  EXPECT_EQ(motion::WriteTrc(*read, "a.trc"), text);
}

TEST(MotionGatherer, WhatCameBeforeTheTPoseIsLeftOut) {
  MotionGatherer gatherer(Chain());
  for (int i = 0; i < 5; ++i) gatherer.Add(FrameAt(i / 120.0, 0, false));
  EXPECT_TRUE(gatherer.empty());
  EXPECT_FALSE(gatherer.Finish().ok());
}

TEST(MotionGatherer, TimeThatGoesBackIsRefused) {
  MotionGatherer gatherer(Chain());
  gatherer.Add(FrameAt(1, 0));
  gatherer.Add(FrameAt(0.5, 0));
  EXPECT_EQ(gatherer.Finish().error().kind, ErrorKind::kInvalidData);
}

TEST(MotionGatherer, TimeThatLeapsFarIsRefusedBeforeItsRowsTakeMemory) {
  MotionGatherer gatherer(Chain());
  for (const double time_s : {0.0, 0.002, 1e9}) gatherer.Add(FrameAt(time_s, 0));
  for (const std::string& message :
       {gatherer.Finish().error().message, gatherer.Forces().error().message}) {
    EXPECT_NE(message.find("500000000000 frames between"), std::string::npos) << message;
  }
}

TEST(JointPlaces, AreTheLinksOfEveryFrameInTheAxesOfOpenSim) {
  MotionGatherer gatherer(Chain());
  for (int i = 0; i < 60; ++i) gatherer.Add(FrameAt(7 + i / 120.0, 0.02 * i));
  const auto motion = gatherer.Finish();
  ASSERT_TRUE(motion.ok()) << motion.error().message;
  // Through the file and back: places in mm with decimals.
  const auto read = motion::ParseTrc(
      motion::WriteTrc(JointPlaces(*motion, std::vector<bool>(60, true)), "a.trc"), "a.trc");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->names, (std::vector<std::string>{"root", "spine", "top"}));
  EXPECT_EQ(read->start_s, 0);
  ASSERT_EQ(read->frames(), 60);
  EXPECT_NEAR(read->p[0](1, 0), 1, 1e-5);  // The root is 1 m above the floor: y is up.
  for (const int i : {0, 30, 59}) {
    const v1::CharacterFrame frame = FrameAt(7 + i / 120.0, 0.02 * i);
    for (int link = 0; link < 3; ++link) {
      const Eigen::Vector3d true_m = wire::FromProto(frame.characters(0).links(link).position_m());
      const Eigen::Vector3d p_W = motion::ToWorld(
          motion::FileAxes::kYUp, Eigen::Vector3d(read->p[static_cast<std::size_t>(link)].col(i)));
      EXPECT_NEAR((p_W - true_m).norm(), 0, 1e-5) << i << " " << link;
    }
  }
}

TEST(ExportBodies, SaysWhereInTheRecordingItsFilesBegin) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("walk.mcap");
  auto writer = recording::RecordingWriter::Create(path, {"test", true, {}});
  ASSERT_TRUE(writer.ok());
  std::uint32_t sequence = 0;
  const auto write = [&](const char* topic, const google::protobuf::Message& message,
                         double log_s) {
    const auto at_ns = static_cast<std::int64_t>(log_s * 1e9);
    ASSERT_TRUE(writer->Write(topic, message, {at_ns, at_ns, ++sequence}));
  };
  v1::Skeletons skeletons;
  *skeletons.add_skeletons() = Chain();
  write("/footing-sim/skeletons", skeletons, 5);
  write("/footing-sim/characters", FrameAt(0.5, 0, false), 6);
  for (int i = 0; i < 4; ++i) {
    v1::CharacterFrame frame = FrameAt(2 + 0.25 * i, 0);
    frame.mutable_characters(0)->set_valid(i < 3);
    write("/footing-sim/characters", frame, 7.5 + i);
  }
  ASSERT_TRUE(writer->Finish());
  for (const auto& [format, name] : {std::pair{BodyFormat::kBvh, "pose_1_p07.bvh"},
                                     std::pair{BodyFormat::kTrc, "pose_1_p07.trc"},
                                     std::pair{BodyFormat::kC3d, "pose_1_p07.c3d"}}) {
    const auto exported = ExportBodies(path, folder.Path("out"), format, false);
    ASSERT_TRUE(exported.ok()) << exported.error().message;
    ASSERT_EQ(exported->size(), 1U);
    EXPECT_EQ((*exported)[0].path, folder.Path("out") + "/" + name);
    EXPECT_EQ((*exported)[0].frames, 4U);
    EXPECT_EQ((*exported)[0].invalid_frames, 1U);
    EXPECT_NEAR((*exported)[0].begin_s, 2.5, 1e-9);
  }
  // A chain has no knees.
  const auto angles = ExportBodies(path, folder.Path("out"), BodyFormat::kMot, false);
  ASSERT_FALSE(angles.ok());
  EXPECT_EQ(angles.error().kind, ErrorKind::kInvalidData);
  EXPECT_NE(angles.error().message.find("walk.mcap"), std::string::npos);
}

TEST(ExportBodies, AFileThatIsNoneIsRefusedByName) {
  const auto exported = ExportBodies("/nowhere/walk.mcap", "/tmp", BodyFormat::kTrc, false);
  ASSERT_FALSE(exported.ok());
  EXPECT_NE(exported.error().message.find("/nowhere/walk.mcap"), std::string::npos);
}

TEST(ForceTable, IsReadAgainAsTheForcesOfTwoPlates) {
  std::vector<motion::FootForces> forces(3);
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

/// A biped that walks ahead, turned to the left by 0.5 rad, on legs of changing length.
v1::CharacterFrame BipedFrame(int i) {
  v1::CharacterFrame frame;
  frame.set_time_s(0.01 * i);
  v1::Character& character = *frame.add_characters();
  character.set_valid(true);
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(0.5, Vector3d::UnitZ()));
  const Vector3d body(0.02 * i, 0.3, 0.95);
  *character.add_links() = wire::ToProto(stream::LinkPose{body, turned});
  for (const double side : {1.0, -1.0}) {
    const Vector3d hip = body + turned * Vector3d(0, 0.1 * side, 0);
    const Eigen::Quaterniond swung =
        turned * Eigen::AngleAxisd(0.3 * side * std::sin(0.1 * i), Vector3d::UnitY());
    const double leg_m = 0.9 + 0.05 * side * std::cos(0.1 * i);
    *character.add_links() = wire::ToProto(stream::LinkPose{hip, swung});
    *character.add_links() =
        wire::ToProto(stream::LinkPose{hip - swung * Vector3d(0, 0, leg_m - 0.4), swung});
    v1::Contact& contact = *character.add_contacts();
    contact.set_touching(side > 0);
    contact.set_normal_force_n(side > 0 ? 700 : 0);
    const Vector3d foot = hip - swung * Vector3d(0, 0, leg_m);
    contact.mutable_position_m()->set_x(foot.x());
    contact.mutable_position_m()->set_y(foot.y());
  }
  return frame;
}

class BipedExportTest : public TemporaryFolder {
 protected:
  static constexpr int kFrames = 40;
  BipedExportTest() {
    auto writer = recording::RecordingWriter::Create(Path("gait.mcap"), {"test", false, {}});
    v1::Skeletons skeletons;
    v1::Skeleton& skeleton = *skeletons.add_skeletons();
    skeleton.set_name("bird");
    for (const auto& [name, parent, height_m] :
         std::vector<std::tuple<std::string, int, double>>{{"body", -1, 0.2},
                                                           {"left_hip", 0, 0.4},
                                                           {"left_knee", 1, 0.8},
                                                           {"right_hip", 0, 0.4},
                                                           {"right_knee", 3, 0.8}}) {
      v1::Link& link = *skeleton.add_links();
      link.set_name(name);
      link.set_parent(parent);
      link.mutable_size_m()->set_z(height_m);
    }
    FOOTING_CHECK(writer->Write("/footing-sim/skeletons", skeletons, {0, 0, 0}).ok());
    for (int i = 0; i < kFrames; ++i) {
      const recording::Stamp stamp{10'000'000ll * i, 0, static_cast<std::uint32_t>(i)};
      FOOTING_CHECK(writer->Write("/footing-sim/characters", BipedFrame(i), stamp).ok());
    }
    FOOTING_CHECK(writer->Finish().ok());
  }

  std::vector<ExportedMotion> Export(BodyFormat format, BvhSkeleton skeleton = BvhSkeleton::kCmu) {
    const auto exported =
        ExportBodies(Path("gait.mcap"), Path("out"), format, /*replace=*/true, skeleton);
    EXPECT_TRUE(exported.ok()) << exported.error().message;
    return exported ? *exported : std::vector<ExportedMotion>();
  }
};

TEST_F(BipedExportTest, ItsHipsAndAnklesAreWhereTheSimulationHasHipsAndFeet) {
  for (const auto skeleton : {BvhSkeleton::kCmu, BvhSkeleton::kHumanoid}) {
    const auto exported = Export(BodyFormat::kBvh, skeleton);
    ASSERT_EQ(exported.size(), 1u);
    EXPECT_EQ(exported[0].path, Path("out/gait_1.bvh"));
    EXPECT_EQ(exported[0].angle_errors, "") << "nothing about a simulation is estimated";
    const auto motion = motion::ParseBvh(Bytes(exported[0].path), "gait_1.bvh");
    ASSERT_TRUE(motion.ok()) << motion.error().message;
    ASSERT_EQ(motion->frames(), kFrames);
    const bool is_cmu = skeleton == BvhSkeleton::kCmu;
    const int hip = body::FindJoint(motion->skeleton, is_cmu ? "lfemur" : "LeftUpperLeg");
    const int knee = body::FindJoint(motion->skeleton, is_cmu ? "ltibia" : "LeftLowerLeg");
    const int ankle = body::FindJoint(motion->skeleton, is_cmu ? "lfoot" : "LeftFoot");
    ASSERT_GE(ankle, 0);
    body::Kinematics at(motion->skeleton);
    for (int i = 0; i < kFrames; ++i) {
      body::ComputeKinematics(motion->skeleton, motion->q.col(i), at);
      const v1::CharacterFrame biped = BipedFrame(i);
      const auto place = [&](int joint) { return at.p_WJ[static_cast<std::size_t>(joint)]; };
      const v1::Character& character = biped.characters(0);
      EXPECT_LT((place(hip) - wire::FromProto(character.links(1).position_m())).norm(), 1e-4) << i;
      const Vector3d foot = wire::FromProto(character.contacts(0).position_m());
      EXPECT_LT((place(ankle) - foot).head<2>().norm(), 1e-4) << i;
      const Vector3d leg = place(ankle) - place(hip), thigh = place(knee) - place(hip);
      const Vector3d ahead(std::cos(0.5), std::sin(0.5), 0);
      EXPECT_GT((thigh - leg * thigh.dot(leg) / leg.squaredNorm()).dot(ahead), 0)
          << "its knees bend forwards";
    }
  }
}

TEST_F(BipedExportTest, EveryFormatOfBodiesHasIt) {
  EXPECT_EQ(Export(BodyFormat::kTrc).at(0).frames, static_cast<std::uint64_t>(kFrames));
  const auto mot = Export(BodyFormat::kMot);
  ASSERT_EQ(mot.size(), 2u);
  const auto angles = motion::ParseTable(Bytes(mot[0].path), "gait_1.mot");
  ASSERT_TRUE(angles.ok()) << angles.error().message;
  EXPECT_NEAR(angles->values(5, motion::FindColumn(*angles, "pelvis_rotation")), 0.5 * 180 / M_PI,
              1e-3);
  EXPECT_GT(angles->values(5, motion::FindColumn(*angles, "knee_angle_r")), 5);
  const auto forces = motion::ParseTable(Bytes(Path("out/gait_1_grf.mot")), "grf");
  ASSERT_TRUE(forces.ok()) << forces.error().message;
  EXPECT_EQ(forces->values(5, motion::FindColumn(*forces, "ground_force_l_vy")), 700);
  EXPECT_EQ(forces->values(5, motion::FindColumn(*forces, "ground_force_r_vy")), 0);
  EXPECT_FALSE(std::filesystem::exists(Path("out/gait_1_errors.csv")));
  const std::string c3d = Bytes(Export(BodyFormat::kC3d).at(0).path);
  EXPECT_TRUE(
      motion::ParseC3d(std::vector<std::uint8_t>(c3d.begin(), c3d.end()), "gait_1.c3d").ok());
}

}  // namespace
}  // namespace footing::log_client
