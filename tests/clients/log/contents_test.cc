#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <Eigen/Geometry>
#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <nlohmann/json.hpp>

#include "clients/log/contents.h"
#include "clients/log/export_bodies.h"
#include "clients/log/export_xdf.h"
#include "common/base/units.h"
#include "common/body/angle_deviation.h"
#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/recording/recording_writer.h"
#include "common/recording/stream_recorder.h"
#include "common/virtual/motion/table.h"
#include "common/wire/wire.h"
#include "footing/v1/session.pb.h"
#include "tests/clients/log/sample_recording.h"
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
    character.mutable_body()->set_mass_kg(75);
    character.mutable_body()->set_height_m(1.75);
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
  // For plots: too short for a standing that angles could change from, and no angle where not
  // valid.
  const std::string csv = Bytes(Path("out/pose_1_p07_angles.csv"));
  EXPECT_EQ(csv.rfind("time_s,valid,pelvis_tilt_deg,", 0), 0u) << csv;
  const std::string last = csv.substr(csv.rfind('\n', csv.size() - 2) + 1);
  const std::size_t cells = last.find(",0,");
  ASSERT_NE(cells, std::string::npos) << last;
  EXPECT_EQ(last.find_first_not_of(",\n", cells + 3), std::string::npos) << last;
}

/// Reads a model by OpenSim's rules and moves it: places of its markers, in OpenSim's axes.
class OpenSimReader {
 public:
  using Tree = boost::property_tree::ptree;

  static Tree Parse(const std::string& text) {
    std::istringstream stream(text);
    Tree tree;
    boost::property_tree::read_xml(stream, tree, boost::property_tree::xml_parser::trim_whitespace);
    EXPECT_EQ(tree.get<int>("OpenSimDocument.<xmlattr>.Version"), 40000);
    return tree;
  }

  explicit OpenSimReader(const std::string& text)
      : model_(Parse(text).get_child("OpenSimDocument.Model")) {
    for (const auto& [type, body] : model_.get_child("BodySet.objects")) {
      EXPECT_EQ(type, "Body");
      EXPECT_TRUE(bodies.insert(NameOf(body)).second) << NameOf(body);
      mass_kg += body.get<double>("mass");
      const auto inertia = NumbersOf(body.get<std::string>("inertia"), 6);
      for (int i = 0; i < 3; ++i) {
        EXPECT_GT(inertia[i], 0) << NameOf(body);
        EXPECT_LE(inertia[i], inertia[(i + 1) % 3] + inertia[(i + 2) % 3] + 1e-7) << NameOf(body);
      }
    }
    for (const auto& [type, joint] : model_.get_child("JointSet.objects")) {
      EXPECT_EQ(type, "CustomJoint");
      for (const auto& [kind, one] : joint.get_child("coordinates")) {
        EXPECT_TRUE(coordinates.insert(NameOf(one)).second) << NameOf(one);
      }
    }
  }

  static std::string NameOf(const Tree& tree) { return tree.get<std::string>("<xmlattr>.name"); }
  static std::vector<double> NumbersOf(const std::string& text, std::size_t count) {
    std::istringstream stream(text);
    std::vector<double> numbers{std::istream_iterator<double>(stream), {}};
    EXPECT_TRUE(stream.eof()) << text;
    EXPECT_EQ(numbers.size(), count) << text;
    numbers.resize(count);
    return numbers;
  }
  static Eigen::Vector3d VectorOf(const std::string& text) {
    return Eigen::Vector3d(NumbersOf(text, 3).data());
  }

  /// `values`: rad and m, by coordinate.
  std::map<std::string, Eigen::Vector3d> Markers(
      const std::map<std::string, double>& values) const {
    std::map<std::string, Eigen::Isometry3d> at{{"/ground", Eigen::Isometry3d::Identity()}};
    for (const auto& [type, joint] : model_.get_child("JointSet.objects")) {
      std::map<std::string, std::pair<std::string, Eigen::Isometry3d>> frames;
      for (const auto& [kind, frame] : joint.get_child("frames")) {
        EXPECT_EQ(kind, "PhysicalOffsetFrame");
        Eigen::Isometry3d offset = Eigen::Isometry3d::Identity();
        offset.translation() = VectorOf(frame.get<std::string>("translation"));
        EXPECT_EQ(VectorOf(frame.get<std::string>("orientation")), Eigen::Vector3d(0, 0, 0));
        frames[NameOf(frame)] = {frame.get<std::string>("socket_parent"), offset};
      }
      const auto parent = frames.at(joint.get<std::string>("socket_parent_frame"));
      const auto child = frames.at(joint.get<std::string>("socket_child_frame"));
      EXPECT_TRUE(at.count(parent.first) == 1) << "no body " << parent.first << " before its child";
      EXPECT_TRUE(at.count(child.first) == 0) << child.first << " has two parents";
      Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
      for (const auto& [kind, axis] : joint.get_child("SpatialTransform")) {
        const auto name = axis.get<std::string>("coordinates");
        if (name.empty()) continue;
        const double value = values.at(name);
        const Eigen::Vector3d along = VectorOf(axis.get<std::string>("axis"));
        EXPECT_EQ(axis.get<std::string>("LinearFunction.coefficients"), "1 0");
        if (NameOf(axis).starts_with("rotation")) {
          moved.rotate(Eigen::AngleAxisd(value, along));
        } else {
          moved.translation() += value * along;
        }
      }
      at[child.first] = at[parent.first] * parent.second * moved * child.second.inverse();
    }
    EXPECT_EQ(at.size(), bodies.size() + 1) << "a body without a joint";
    std::map<std::string, Eigen::Vector3d> markers;
    for (const auto& [type, marker] : model_.get_child("MarkerSet.objects")) {
      markers[NameOf(marker)] = at.at(marker.get<std::string>("socket_parent_frame")) *
                                VectorOf(marker.get<std::string>("location"));
    }
    return markers;
  }

  std::set<std::string> bodies, coordinates;
  double mass_kg = 0;

 private:
  Tree model_;
};

TEST_F(AngleErrorsTest, AMotHasAModelThatMovesItsMarkersToTheJoints) {
  const auto exported = ExportBodies(Path("walk.mcap"), Path("out"), BodyFormat::kMot, false);
  ASSERT_TRUE(exported.ok()) << exported.error().message;
  const OpenSimReader model(Bytes(Path("out/pose_1_p07.osim")));
  EXPECT_NEAR(model.mass_kg, 75, 1e-6);
  const auto angles = motion::ParseTable(Bytes(Path("out/pose_1_p07.mot")), "a.mot");
  ASSERT_TRUE(angles.ok()) << angles.error().message;
  EXPECT_EQ(model.coordinates,
            std::set<std::string>(angles->columns.begin() + 1, angles->columns.end()));
  for (int frame = 0; frame < kFrames; ++frame) {
    std::map<std::string, double> values;
    for (std::size_t i = 1; i < angles->columns.size(); ++i) {
      const std::string& name = angles->columns[i];
      const double value = angles->values(frame, static_cast<Eigen::Index>(i));
      values[name] =
          name.starts_with("pelvis_t") && name != "pelvis_tilt" ? value : DegreesToRadians(value);
    }
    const auto markers = model.Markers(values);
    (void)FrameAt(frame);  // Moves at_.
    ASSERT_EQ(markers.size(), at_.p_WJ.size());
    for (std::size_t i = 0; i < at_.p_WJ.size(); ++i) {
      const Eigen::Vector3d& p = at_.p_WJ[i];
      EXPECT_LT(
          (markers.at(skeleton_.joints[i].name) - Eigen::Vector3d(p.x(), p.z(), -p.y())).norm(),
          1e-4)
          << frame << " " << skeleton_.joints[i].name;
    }
  }
}

TEST_F(AngleErrorsTest, ItsExternalLoadsNameColumnsAndBodiesThatAreThere) {
  ASSERT_TRUE(ExportBodies(Path("walk.mcap"), Path("out"), BodyFormat::kMot, false).ok());
  const OpenSimReader model(Bytes(Path("out/pose_1_p07.osim")));
  const auto loads = OpenSimReader::Parse(Bytes(Path("out/pose_1_p07_loads.xml")))
                         .get_child("OpenSimDocument.ExternalLoads");
  const auto file = loads.get<std::string>("datafile");
  const auto forces = motion::ParseTable(Bytes(Path("out/" + file)), file);
  ASSERT_TRUE(forces.ok()) << forces.error().message;
  std::set<std::string> loaded;
  for (const auto& [type, force] : loads.get_child("objects")) {
    ASSERT_EQ(type, "ExternalForce");
    loaded.insert(force.get<std::string>("applied_to_body"));
    EXPECT_EQ(force.get<std::string>("force_expressed_in_body"), "ground");
    EXPECT_EQ(force.get<std::string>("point_expressed_in_body"), "ground");
    for (const char* part : {"force", "point", "torque"}) {
      for (const char* axis : {"x", "y", "z"}) {
        const auto column = force.get<std::string>(std::string(part) + "_identifier") + axis;
        EXPECT_GE(motion::FindColumn(*forces, column), 0) << column;
      }
    }
  }
  EXPECT_EQ(loaded, (std::set<std::string>{"calcn_l", "calcn_r"}));
  for (const std::string& body : loaded) EXPECT_EQ(model.bodies.count(body), 1u);
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

TEST_F(AngleErrorsTest, ATidyTableIsNamedByJointAndHasACodebook) {
  const auto exported = ExportCsv(Path("walk.mcap"), Path("tidy"), false, /*tidy=*/true);
  ASSERT_TRUE(exported.ok()) << exported.error().message;
  EXPECT_EQ(exported->back().path, Path("tidy/codebook.json"));
  const std::string text = Bytes(Path("tidy/footing-sim_characters.csv"));
  const std::vector<std::string> names = Cells(text, 0);
  EXPECT_EQ(names.at(0), "time_s");
  const auto column = std::find(names.begin(), names.end(), "ltibia_position_z_m");
  ASSERT_NE(column, names.end());
  EXPECT_THAT(names, testing::Each(testing::Not(HasSubstr("links_"))));
  const auto knee = static_cast<std::size_t>(body::FindJoint(skeleton_, "ltibia"));
  for (int i = 0; i < kFrames; ++i) {
    const std::vector<std::string> cells = Cells(text, static_cast<std::size_t>(1 + i));
    EXPECT_NEAR(std::stod(cells.at(0)), 0.01 + 0.01 * i, 1e-9);  // The skeleton came at 0 s.
    (void)FrameAt(i);
    EXPECT_NEAR(std::stod(cells.at(static_cast<std::size_t>(column - names.begin()))),
                at_.p_WJ[knee].z(), 5e-7);
  }
  // Every column is in the codebook, and nothing else.
  const auto book = nlohmann::ordered_json::parse(Bytes(Path("tidy/codebook.json")));
  std::vector<std::string> described;
  for (const auto& [name, entry] : book["footing-sim_characters.csv"].items()) {
    described.push_back(name);
  }
  EXPECT_EQ(described, names);
  EXPECT_EQ(book["footing-sim_characters.csv"]["ltibia_position_z_m"]["unit"], "m");
  EXPECT_EQ(book["footing-sim_characters.csv"]["valid"]["type"], "flag");
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

class ContentsTest : public TemporaryFolder {};

TEST_F(ContentsTest, TopicsCountsRatesAndGapsAreThoseRecorded) {
  WriteSampleRecording(Path("a.mcap"), true);
  const auto contents = ReadContents(Path("a.mcap"));
  ASSERT_TRUE(contents.ok()) << contents.error().message;
  EXPECT_TRUE(contents->end.complete) << contents->end.problem;
  EXPECT_FALSE(Incomplete("a", contents->end).has_value());
  ASSERT_EQ(contents->topics.size(), 3u);
  EXPECT_EQ(contents->topics[0].name, "/footingd/gaps");
  EXPECT_EQ(contents->topics[1].name, "/footingd/motion");
  EXPECT_EQ(contents->topics[1].schema, "footing.v1.MotionSamples");
  EXPECT_EQ(contents->topics[1].messages, 300u);
  EXPECT_NEAR(contents->topics[1].RateHz(), 100, 1e-9);
  EXPECT_EQ(contents->topics[2].messages, 6u);  // Ticks 0, 50, ... 250.
  EXPECT_EQ(contents->end_ns - contents->start_ns, 2'990'000'000u);
  EXPECT_EQ(contents->gaps, 1u);
  EXPECT_EQ(contents->missing_ticks, 5u);
  ASSERT_EQ(contents->attachments.size(), 1u);
  EXPECT_EQ(contents->attachments[0].name, "config.json");
}

TEST_F(ContentsTest, SaysWhetherDevicesWereSimulated) {
  WriteSampleRecording(Path("made.mcap"), true);
  WriteSampleRecording(Path("real.mcap"), false);
  EXPECT_EQ(ReadContents(Path("made.mcap")).value().simulated, true);
  EXPECT_EQ(ReadContents(Path("real.mcap")).value().simulated, false);
}

TEST_F(ContentsTest, ARestartOfAServerIsCountedApart) {
  auto writer = recording::RecordingWriter::Create(Path("a.mcap"), {"test", false, {}});
  ASSERT_TRUE(writer.ok()) << writer.error().message;
  v1::Gap gap;
  gap.set_from_sequence(450);
  gap.set_reason(v1::Gap::REASON_NEW_EPOCH);  // Nobody knows how many: to_sequence is 0.
  ASSERT_TRUE(writer->Write("/footingd/gaps", gap, {0, 0, 0}).ok());
  ASSERT_TRUE(writer->Finish().ok());
  const auto contents = ReadContents(Path("a.mcap"));
  ASSERT_TRUE(contents.ok()) << contents.error().message;
  EXPECT_EQ(contents->gaps, 1u);
  EXPECT_EQ(contents->missing_ticks, 0u);
  EXPECT_EQ(contents->restarts, 1u);
}

TEST_F(ContentsTest, TellsHowLongTheTicksAreMissing) {
  auto writer = recording::RecordingWriter::Create(Path("a.mcap"), {"test", false, {}});
  ASSERT_TRUE(writer.ok()) << writer.error().message;
  recording::StreamRecorder recorder(*writer, "unix:/x", [](const std::string& id) { return id; });
  v1::Welcome welcome;
  welcome.set_server_id("footingd");
  ASSERT_TRUE(recorder.OnWelcome(welcome, 0).ok());
  const auto tick_at = [&](std::uint64_t sequence, std::int64_t ms) {
    v1::Tick tick;
    tick.set_sequence(sequence);
    tick.set_host_ns(ms * 1'000'000);
    tick.mutable_motion();
    ASSERT_TRUE(recorder.OnTick(tick, tick.host_ns()).ok());
  };
  v1::Gap dropped;
  dropped.set_from_sequence(3);
  dropped.set_to_sequence(22);
  v1::Gap restarted;
  restarted.set_from_sequence(25);
  restarted.set_reason(v1::Gap::REASON_NEW_EPOCH);
  tick_at(1, 1000);
  tick_at(2, 1010);
  ASSERT_TRUE(recorder.OnGap(dropped, 0).ok());
  tick_at(23, 1220);  // 20 ticks of 10 ms in between.
  tick_at(24, 1230);
  // After a restart: a snapshot of the present, the gap, and the first ticks out of the ring.
  tick_at(31, 4000);
  ASSERT_TRUE(recorder.OnGap(restarted, 0).ok());
  tick_at(1, 3700);
  tick_at(2, 3710);
  tick_at(32, 4010);
  ASSERT_TRUE(writer->Finish().ok());
  const auto contents = ReadContents(Path("a.mcap"));
  ASSERT_TRUE(contents.ok()) << contents.error().message;
  EXPECT_EQ(contents->missing_ticks, 20u);
  EXPECT_NEAR(contents->missing_s, 20 * 0.010, 1e-9);
  EXPECT_EQ(contents->restarts, 1u);
  EXPECT_NEAR(contents->restart_s, 3.700 - 1.230, 1e-9);
}

TEST_F(ContentsTest, TheSameStreamGivesTheSameBytes) {
  WriteSampleRecording(Path("a.mcap"), true);
  WriteSampleRecording(Path("b.mcap"), true);
  EXPECT_EQ(Bytes(Path("a.mcap")), Bytes(Path("b.mcap")));
}

TEST_F(ContentsTest, ACutRecordingNamesItsPlaceAndTheRepair) {
  WriteSampleRecording(Path("a.mcap"), true);
  const std::string whole = Bytes(Path("a.mcap"));
  Save(Path("cut.mcap"), whole.substr(0, whole.size() / 2));
  const auto contents = ReadContents(Path("cut.mcap"));
  ASSERT_TRUE(contents.ok());
  EXPECT_GT(contents->messages, 0u);
  const auto error = Incomplete(Path("cut.mcap"), contents->end);
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->kind, ErrorKind::kInvalidData);
  EXPECT_THAT(error->message, HasSubstr("cut short at byte"));
  EXPECT_THAT(error->message, HasSubstr("footing-log repair"));
}

TEST_F(ContentsTest, SomethingElseIsNoRecording) {
  Save(Path("text.mcap"), "hello");
  Save(Path("empty.mcap"), "");
  EXPECT_EQ(ReadContents(Path("text.mcap")).error().kind, ErrorKind::kInvalidData);
  EXPECT_EQ(ReadContents(Path("empty.mcap")).error().kind, ErrorKind::kInvalidData);
  EXPECT_EQ(ReadContents(Path("none.mcap")).error().kind, ErrorKind::kFailure);
}

class ExportBidsTest : public TemporaryFolder {
 protected:
  Result<ExportedBids> Export(const std::string& subject, bool replace = false) {
    return ExportBids(Path("long walk.mcap"), Path("data"), {subject, "", replace, "1.0"});
  }
};

TEST_F(ExportBidsTest, TheFilesOfADataSetFitTogether) {
  WriteSampleRecording(Path("long walk.mcap"), true);
  const auto exported = Export("01");
  ASSERT_TRUE(exported.ok()) << exported.error().message;
  ASSERT_EQ(exported->tables.size(), 1u);
  const ExportedTable& table = exported->tables[0];
  EXPECT_EQ(table.samples, static_cast<std::size_t>(kSampleTicks));
  const std::string stem = Path("data/sub-01/motion/sub-01_task-longwalk");
  EXPECT_EQ(table.path, stem + "_tracksys-" + table.tracking_system + "_motion.tsv");
  const std::string motion = Bytes(table.path);
  EXPECT_EQ(std::count(motion.begin(), motion.end(), '\n'), kSampleTicks);
  const std::string first = motion.substr(0, motion.find('\n'));
  EXPECT_EQ(static_cast<std::size_t>(std::count(first.begin(), first.end(), '\t')) + 1,
            table.channels);
  const auto about = table.path.substr(0, table.path.rfind('_'));
  const std::string channels = Bytes(about + "_channels.tsv");
  EXPECT_EQ(static_cast<std::size_t>(std::count(channels.begin(), channels.end(), '\n')),
            table.channels + 1);  // And the names of its columns.
  const auto json = nlohmann::json::parse(Bytes(about + "_motion.json"));
  EXPECT_EQ(json["TaskName"], "longwalk");
  EXPECT_EQ(json["MotionChannelCount"], table.channels);
  EXPECT_NEAR(json["SamplingFrequency"].get<double>(), 100, 1e-6);
  EXPECT_EQ(nlohmann::json::parse(Bytes(Path("data/dataset_description.json")))["BIDSVersion"],
            "1.9.0");
  EXPECT_THAT(Bytes(stem + "_events.tsv"), HasSubstr("onset\tduration\ttrial_type"));
  EXPECT_EQ(Bytes(Path("data/participants.tsv")), "participant_id\nsub-01\n");
}

TEST_F(ExportBidsTest, AnotherSubjectJoinsTheDataSetAndTheFirstOneStays) {
  WriteSampleRecording(Path("long walk.mcap"), true);
  ASSERT_TRUE(Export("01").ok());
  Save(Path("data/participants.tsv"), "participant_id\tage\nsub-01\t30\n");
  ASSERT_TRUE(Export("02").ok());
  EXPECT_EQ(Bytes(Path("data/participants.tsv")), "participant_id\tage\nsub-01\t30\nsub-02\tn/a\n");
  const auto again = Export("02");
  ASSERT_FALSE(again.ok());
  EXPECT_EQ(again.error().kind, ErrorKind::kUsage);
  EXPECT_TRUE(Export("02", /*replace=*/true).ok());
  EXPECT_EQ(Bytes(Path("data/participants.tsv")), "participant_id\tage\nsub-01\t30\nsub-02\tn/a\n");
}

TEST_F(ExportBidsTest, RefusesALabelThatTheStandardDoesNotTake) {
  WriteSampleRecording(Path("long walk.mcap"), true);
  const auto exported = Export("p_7");
  ASSERT_FALSE(exported.ok());
  EXPECT_EQ(exported.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(exported.error().message, HasSubstr("--subject 'p_7'"));
  EXPECT_FALSE(std::filesystem::exists(Path("data")));
}

using testing::EndsWith;
using testing::StartsWith;

class ExportCsvTest : public TemporaryFolder {};

TEST_F(ExportCsvTest, OneFileATopicWithARowASample) {
  WriteSampleRecording(Path("a.mcap"), true);
  const auto files = ExportCsv(Path("a.mcap"), Path("csv"), false);
  ASSERT_TRUE(files.ok()) << files.error().message;
  ASSERT_EQ(files->size(), 3u);
  const std::string motion = Bytes(Path("csv/footingd_motion.csv"));
  EXPECT_THAT(motion, StartsWith("log_time_ns,publish_time_ns,sequence,device,report_count,"));
  EXPECT_EQ(std::count(motion.begin(), motion.end(), '\n'), kSampleTicks + 1);
  EXPECT_THAT(motion, HasSubstr("\n1000000000,1000000000,100,1,100,0,0,0,0,-9.80665,"));
  EXPECT_THAT(Bytes(Path("csv/footingd_status.csv")), HasSubstr("\"battery, \"\"low\"\"\""));
  EXPECT_THAT(Bytes(Path("csv/footingd_gaps.csv")), HasSubstr(",101,105,"));
}

/// One device with a role, one character with named links, and a server whose wall time is known.
void WriteNamedRecording(const std::string& path) {
  test::MadeRecording recording(path);
  recording.Begin("footingd", 5'000'000'000,
                  1'760'000'005'000'000'000);  // 2025-10-09T08:53:25Z.
  v1::Tick tick;
  tick.set_sequence(1);
  tick.set_host_ns(6'000'000'000);
  v1::DeviceStatus& status = *tick.mutable_status()->add_devices();
  status.set_device(7);
  status.set_role(v1::DEVICE_ROLE_LEFT_BOARD);
  v1::Skeleton& skeleton = *tick.mutable_skeletons()->add_skeletons();
  skeleton.add_links()->set_name("hips");
  skeleton.add_links()->set_name("left,knee");
  skeleton.add_contact_points("left_foot");
  recording.Add(tick);
  tick.Clear();
  tick.set_sequence(2);
  tick.set_host_ns(6'250'000'000);
  tick.mutable_boards()->add_samples()->set_device(7);
  tick.mutable_boards()->add_samples()->set_device(8);
  v1::Character& character = *tick.mutable_characters()->add_characters();
  character.add_links();
  character.add_links();
  recording.Add(tick);
}

TEST_F(ExportCsvTest, RowsSayTheirTimeTheirDevicesRoleAndTheirJointsNames) {
  WriteNamedRecording(Path("a.mcap"));
  ASSERT_TRUE(ExportCsv(Path("a.mcap"), Path("csv"), false).ok());
  const std::string boards = Bytes(Path("csv/footingd_boards.csv"));
  EXPECT_THAT(boards, HasSubstr(",recording_time_s,wall_time,device_role\n"));
  EXPECT_THAT(boards, HasSubstr(",0.250000000,2025-10-09T08:53:26.250000Z,left_board\n"));
  EXPECT_THAT(boards, HasSubstr(",0.250000000,2025-10-09T08:53:26.250000Z,\n"));  // No status.
  const std::string characters = Bytes(Path("csv/footingd_characters.csv"));
  EXPECT_THAT(characters, HasSubstr(",links_0_name,links_1_name,contacts_0_name\n"));
  EXPECT_THAT(characters, HasSubstr(",hips,leftknee,left_foot\n"));
  EXPECT_THAT(Bytes(Path("csv/footingd_status.csv")), HasSubstr(",recording_time_s,wall_time\n"));
}

TEST_F(ExportCsvTest, ATimeThatNoClockShowsHasNoWallTime) {
  for (const std::int64_t begin_ns : {std::int64_t{5'000'000'000}, INT64_MIN}) {
    {
      test::MadeRecording recording(Path("a.mcap"));
      recording.Begin("footingd", begin_ns, 1'760'000'005'000'000'000);
      v1::Tick tick;
      tick.set_sequence(1);
      tick.set_host_ns(INT64_MAX);
      tick.mutable_status()->add_devices()->set_device(7);
      recording.Add(tick);
    }
    ASSERT_TRUE(ExportCsv(Path("a.mcap"), Path("csv"), true).ok());
    EXPECT_THAT(Bytes(Path("csv/footingd_status.csv")), EndsWith(",0.000000000,\n"));
    std::filesystem::remove(Path("a.mcap"));
  }
}

TEST_F(ExportCsvTest, NeverOverwritesUnlessTold) {
  WriteSampleRecording(Path("a.mcap"), true);
  ASSERT_TRUE(ExportCsv(Path("a.mcap"), Path("csv"), false).ok());
  EXPECT_EQ(ExportCsv(Path("a.mcap"), Path("csv"), false).error().kind, ErrorKind::kUsage);
  EXPECT_TRUE(ExportCsv(Path("a.mcap"), Path("csv"), true).ok());
}

TEST_F(ExportCsvTest, ACutRecordingIsRefusedAndNothingIsWritten) {
  WriteSampleRecording(Path("a.mcap"), true);
  const std::string whole = Bytes(Path("a.mcap"));
  Save(Path("cut.mcap"), whole.substr(0, whole.size() - 1));
  const auto files = ExportCsv(Path("cut.mcap"), Path("csv"), false);
  ASSERT_FALSE(files.ok());
  EXPECT_EQ(files.error().kind, ErrorKind::kInvalidData);
  EXPECT_THAT(files.error().message, HasSubstr("repair"));
  EXPECT_FALSE(std::filesystem::exists(Path("csv")));
}

TEST_F(ExportCsvTest, ATopicCannotNameAPathOutsideTheFolder) {
  auto writer = recording::RecordingWriter::Create(Path("a.mcap"), {"test", false, {}});
  ASSERT_TRUE(writer.ok());
  ASSERT_TRUE(writer->Write("/../../evil", v1::Gap(), {1, 1, 1}).ok());
  ASSERT_TRUE(writer->Write("", v1::Gap(), {1, 1, 1}).ok());
  ASSERT_TRUE(writer->Finish().ok());
  const auto files = ExportCsv(Path("a.mcap"), Path("csv"), false);
  ASSERT_TRUE(files.ok()) << files.error().message;
  EXPECT_EQ(files->at(0).path, Path("csv/______evil.csv"));
  EXPECT_EQ(files->at(1).path, Path("csv/topic.csv"));
}

}  // namespace
}  // namespace footing::log_client
