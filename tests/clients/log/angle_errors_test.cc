#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "clients/log/export_bids.h"
#include "clients/log/export_bodies.h"
#include "clients/log/export_csv.h"
#include "clients/log/export_xdf.h"
#include "common/body/angle_deviation.h"
#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/base/units.h"
#include "common/virtual/motion/table.h"
#include "common/wire/wire.h"
#include "footing/v1/session.pb.h"
#include "tests/clients/log/temporary_folder.h"
#include "tests/common/made_recording.h"

namespace footing::log_client {
namespace {

using body::AxisRotation;
using testing::HasSubstr;
using Axis = body::Axis;

/// Upright, upright, knees bent by 60 degrees, and bent in a frame that is not valid.
constexpr int kFrames = 4;

/// Every export of a reconstructed person states how exact its angles are.
class AngleErrorsTest : public TemporaryFolder {
 protected:
  AngleErrorsTest() : skeleton_(body::StandardPerson(1.75)), at_(skeleton_) {
    test::MadeRecording recording(Path("walk.mcap"));
    recording.Begin("footing-sim", 5'000'000'000, 1'760'000'005'000'000'000);
    v1::Tick tick;
    tick.set_sequence(1);
    tick.set_host_ns(6'000'000'000);
    v1::Skeleton& skeleton = *tick.mutable_skeletons()->add_skeletons();
    skeleton.set_name("person");
    for (const body::Joint& joint : skeleton_.joints) {
      v1::Link& link = *skeleton.add_links();
      link.set_name(joint.name);
      link.set_parent(joint.parent);
    }
    recording.Add(tick);
    for (int i = 0; i < kFrames; ++i) {
      tick.Clear();
      tick.set_sequence(static_cast<std::uint64_t>(2 + i));
      tick.set_host_ns(6'010'000'000 + i * 10'000'000);
      *tick.mutable_characters() = FrameAt(i);
      recording.Add(tick);
    }
  }

  v1::CharacterFrame FrameAt(int i) {
    Eigen::VectorXd q = body::TPose(skeleton_, body::FindLandmarks(skeleton_).value());
    if (i >= 2) {
      for (const char* knee : {"ltibia", "rtibia"}) {
        body::SetJointRotation(skeleton_.joint(body::FindJoint(skeleton_, knee)),
                               AxisRotation(Axis::kY, DegreesToRadians(60)), q);
      }
    }
    body::ComputeKinematics(skeleton_, q, at_);
    v1::CharacterFrame frame;
    frame.set_time_s(0.01 * i);
    v1::Character& character = *frame.add_characters();
    character.set_character(1);
    character.set_valid(i < 3);
    character.mutable_body()->set_calibrated(true);
    character.mutable_body()->set_subject("p07");
    for (std::size_t joint = 0; joint < at_.p_WJ.size(); ++joint) {
      *character.add_links() =
          wire::ToProto(stream::LinkPose{at_.p_WJ[joint], Eigen::Quaterniond(at_.R_WJ[joint])});
    }
    return frame;
  }

  /// The cells of a line, from 0 on.
  static std::vector<std::string> Cells(const std::string& text, std::size_t line) {
    std::istringstream lines(text);
    std::string row;
    for (std::size_t i = 0; i <= line; ++i) std::getline(lines, row);
    std::vector<std::string> cells;
    std::istringstream stream(row);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    return cells;
  }

  body::Skeleton skeleton_;
  body::Kinematics at_;
};

TEST_F(AngleErrorsTest, AMotHasATableWithADeviationForEachAngle) {
  const auto exported = ExportBodies(Path("walk.mcap"), Path("out"), BodyFormat::kMot, false);
  ASSERT_TRUE(exported.ok()) << exported.error().message;
  ASSERT_EQ(exported->size(), 2u);  // Angles and forces; what is stated about them is no motion.
  EXPECT_EQ((*exported)[0].angle_errors, Path("out/pose_1_p07_errors.csv"));
  const std::string text = Bytes(Path("out/pose_1_p07.mot"));
  const std::string head = text.substr(0, text.find("endheader"));
  EXPECT_THAT(head, HasSubstr("pose_1_p07_sd.sto"));
  EXPECT_THAT(head, HasSubstr("standard deviations"));
  const auto angles = motion::ParseTable(text, "a.mot");
  ASSERT_TRUE(angles.ok()) << angles.error().message;
  const auto sd = motion::ParseTable(Bytes(Path("out/pose_1_p07_sd.sto")), "a.sto");
  ASSERT_TRUE(sd.ok()) << sd.error().message;
  EXPECT_TRUE(sd->in_degrees);
  ASSERT_EQ(sd->values.rows(), kFrames);
  EXPECT_EQ(sd->values.col(0), angles->values.col(0));
  EXPECT_EQ(motion::FindColumn(*sd, "pelvis_tx"), -1);
  EXPECT_EQ(sd->columns.size(), angles->columns.size() - 3);
  for (std::size_t i = 1; i < sd->columns.size(); ++i) {
    const std::string& column = sd->columns[i];
    const auto stated = body::CoordinateDeviation(column);
    ASSERT_TRUE(stated) << column;
    const auto values = sd->values.col(static_cast<Eigen::Index>(i));
    EXPECT_EQ(values(1), stated->upright_deg) << column;
    EXPECT_EQ(values(2), stated->bent_deg) << column;
    EXPECT_NEAR(values(3), 360 / std::sqrt(12), 1e-3) << column;  // Not valid: any direction.
  }
}

TEST_F(AngleErrorsTest, EveryFormatHasAFileOfErrorsBesideIt) {
  for (const BodyFormat format : {BodyFormat::kBvh, BodyFormat::kTrc, BodyFormat::kC3d}) {
    const auto exported = ExportBodies(Path("walk.mcap"), Path("out"), format, false);
    ASSERT_TRUE(exported.ok()) << exported.error().message;
    ASSERT_EQ(exported->size(), 1u);
    EXPECT_EQ((*exported)[0].angle_errors, Path("out/pose_1_p07_errors.csv"));
  }
  const std::string text = Bytes(Path("out/pose_1_p07_errors.csv"));
  EXPECT_EQ(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')),
            body::CoordinateDeviations().size() + 1);
  EXPECT_THAT(text, testing::StartsWith("coordinate,sd_upright_deg,sd_bent_deg\n"));
  EXPECT_THAT(text, HasSubstr("\nhip_flexion,"));
  // A file of somebody else is not overwritten.
  Save(Path("out/pose_1_p07_errors.csv"), "mine");
  std::filesystem::remove(Path("out/pose_1_p07.bvh"));
  EXPECT_EQ(ExportBodies(Path("walk.mcap"), Path("out"), BodyFormat::kBvh, false).error().kind,
            ErrorKind::kUsage);
}

TEST_F(AngleErrorsTest, ACsvHasAColumnForTheOrientationOfEachLink) {
  ASSERT_TRUE(ExportCsv(Path("walk.mcap"), Path("csv"), false).ok());
  const std::string text = Bytes(Path("csv/footing-sim_characters.csv"));
  const std::vector<std::string> names = Cells(text, 0);
  const int knee = body::FindJoint(skeleton_, "ltibia");
  const auto column = std::find(names.begin(), names.end(),
                                "links_" + std::to_string(knee) + "_orientation_sd_rad");
  ASSERT_NE(column, names.end());
  const auto index = static_cast<std::size_t>(column - names.begin());
  double shank_deg = 0;
  for (const body::AngleDeviation& link : body::LinkDeviations()) {
    if (link.name == "shank") shank_deg = std::max(link.upright_deg, link.bent_deg);
  }
  EXPECT_NEAR(std::stod(Cells(text, 1).at(index)), DegreesToRadians(shank_deg), 1e-3);
  const std::vector<std::string> invalid = Cells(text, kFrames);
  EXPECT_TRUE(invalid.size() <= index || invalid[index].empty());
}

TEST_F(AngleErrorsTest, BidsAndXdfSayIt) {
  const auto bids = ExportBids(Path("walk.mcap"), Path("data"), {"01", "walk", false, "1.0"});
  ASSERT_TRUE(bids.ok()) << bids.error().message;
  const auto json = nlohmann::json::parse(
      Bytes(Path("data/sub-01/motion/sub-01_task-walk_tracksys-body_motion.json")));
  const auto& stated = json["OrientationStandardDeviation"];
  EXPECT_EQ(stated["Units"], "rad");
  EXPECT_GT(stated["TrackedPoints"]["lfemur"]["Bent"].get<double>(), 0);
  const auto xdf = ExportXdf(Path("walk.mcap"), Path("out"), false);
  ASSERT_TRUE(xdf.ok()) << xdf.error().message;
  EXPECT_THAT(Bytes(xdf->path), HasSubstr("<note>orientation_sd_rad of links"));
}

}  // namespace
}  // namespace footing::log_client
