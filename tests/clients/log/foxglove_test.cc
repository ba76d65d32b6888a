#include "clients/log/foxglove.h"

#include <gmock/gmock.h>

#include <map>
#include <string>
#include <vector>

#include "clients/log/contents.h"
#include "common/recording/mcap_reader.h"
#include "foxglove/messages.pb.h"
#include "tests/clients/log/sample_recording.h"
#include "tests/clients/log/temporary_folder.h"

namespace footing::log_client {
namespace {

using testing::HasSubstr;

class FoxgloveTest : public TemporaryFolder {
 protected:
  /// Exports the scene; the messages of a topic by their log times.
  void Export() {
    WriteSceneRecording(Path("scene.mcap"));
    const auto exported = ExportFoxglove(Path("scene.mcap"), Path("out"), "test", false);
    ASSERT_TRUE(exported.ok()) << exported.error().message;
    path_ = exported->path;
    mcap::Visitor visitor;
    visitor.channel = [this](const mcap::Channel& channel) { names_[channel.id] = channel.topic; };
    visitor.message = [this](const mcap::Message& message) {
      topics_[names_[message.channel_id]].emplace_back(message.log_time_ns,
                                                       std::string(message.data));
    };
    const std::string bytes = Bytes(path_);
    ASSERT_TRUE(mcap::Walk(bytes, visitor, mcap::WalkMode::kStrict).complete);
  }

  template <typename Message>
  Message At(const std::string& topic, std::size_t i) {
    Message message;
    EXPECT_LT(i, topics_[topic].size()) << topic;
    EXPECT_TRUE(message.ParseFromString(topics_[topic].at(i).second));
    return message;
  }

  std::string path_;
  std::map<std::uint16_t, std::string> names_;
  std::map<std::string, std::vector<std::pair<std::uint64_t, std::string>>> topics_;
};

TEST_F(FoxgloveTest, LinksFollowTheCharacterThirtyThreeTimesASecond) {
  Export();
  EXPECT_EQ(topics_["/footing-sim/characters"].size(), 100u);
  EXPECT_EQ(topics_["/foxglove/footing-sim/transforms"].size(), 34u);  // Every 30 ms of 1 s.
  const auto last = At<foxglove::FrameTransforms>("/foxglove/footing-sim/transforms", 33);
  ASSERT_EQ(last.transforms_size(), 3);
  EXPECT_EQ(last.transforms(2).child_frame_id(), "footing-sim/0/end_2");
  EXPECT_NEAR(last.transforms(2).translation().x(), 0.99, 1e-12);
  EXPECT_EQ(last.transforms(2).rotation().w(), 1);
  EXPECT_EQ(last.transforms(2).timestamp().nanos(), 990'000'000);
}

TEST_F(FoxgloveTest, TheBodyAndTheTrackAreThereFromTheFirstFrameOn) {
  Export();
  // The snapshot that has them is 0.5 s later than the first frame.
  for (const char* topic : {"/foxglove/footing-sim/body", "/foxglove/footing-sim/track"}) {
    ASSERT_EQ(topics_[topic].size(), 1u) << topic;
    EXPECT_EQ(topics_[topic][0].first, 1'000'000'000u) << topic;
  }
  const auto body = At<foxglove::SceneUpdate>("/foxglove/footing-sim/body", 0);
  ASSERT_EQ(body.entities_size(), 3);
  EXPECT_TRUE(body.entities(0).frame_locked());
  ASSERT_EQ(body.entities(0).cylinders_size(), 1);  // From the hips down to the next joint.
  EXPECT_NEAR(body.entities(0).cylinders(0).size().z(), 0.5, 1e-12);
  EXPECT_NEAR(body.entities(0).cylinders(0).pose().position().z(), -0.25, 1e-12);
  const auto track = At<foxglove::SceneUpdate>("/foxglove/footing-sim/track", 0);
  ASSERT_EQ(track.entities(0).cubes_size(), 2);  // The pit is not one.
  EXPECT_NEAR(track.entities(0).cubes(1).pose().position().x(), 5, 1e-12);
  EXPECT_NEAR(track.entities(0).cubes(1).pose().position().z(), -0.05, 1e-12);
}

TEST_F(FoxgloveTest, AForceIsAnArrowUpOfAMillimetreANewton) {
  Export();
  const auto forces = At<foxglove::SceneUpdate>("/foxglove/footing-sim/forces", 0);
  ASSERT_EQ(forces.entities(0).arrows_size(), 1);
  const foxglove::ArrowPrimitive& arrow = forces.entities(0).arrows(0);
  EXPECT_NEAR(arrow.shaft_length() + arrow.head_length(), 0.5, 1e-12);
  EXPECT_NEAR(arrow.pose().position().y(), 0.1, 1e-12);
  // It points along the x of its pose: turned by q it is (1 - 2 (y^2 + z^2), ..., 2 (xz - wy)).
  const auto& q = arrow.pose().orientation();
  EXPECT_NEAR(2 * (q.x() * q.z() - q.w() * q.y()), 1, 1e-12);
}

TEST_F(FoxgloveTest, BoardsLieInTheirFramesWithTheCopOfThoseThatCarry) {
  Export();
  // Once with the first loads, and again with the layout, which stands behind them in the file.
  ASSERT_EQ(topics_["/foxglove/footingd/transforms"].size(), 2u);
  const auto places = At<foxglove::FrameTransforms>("/foxglove/footingd/transforms", 1);
  ASSERT_EQ(places.transforms_size(), 2);
  EXPECT_EQ(places.transforms(0).child_frame_id(), "footingd/main/left_board");
  EXPECT_GT(places.transforms(0).translation().y(), 0.1);
  const auto boards = At<foxglove::SceneUpdate>("/foxglove/footingd/boards", 0);
  ASSERT_EQ(boards.entities_size(), 2);
  EXPECT_EQ(boards.entities(0).arrows_size(), 1);
  EXPECT_EQ(boards.entities(1).arrows_size(), 0);
  EXPECT_EQ(boards.entities(1).cubes_size(), 1);
}

TEST_F(FoxgloveTest, EventsOfOneTickRiseByANanosecond) {
  Export();
  const auto& log = topics_["/foxglove/footingd/log"];
  ASSERT_EQ(log.size(), 2u);
  EXPECT_EQ(log[1].first, log[0].first + 1);
  EXPECT_EQ(At<foxglove::Log>("/foxglove/footingd/log", 0).message(), "stimulus on 3");
  EXPECT_EQ(At<foxglove::Log>("/foxglove/footing-sim/log", 0).level(), foxglove::Log::WARNING);
}

TEST_F(FoxgloveTest, ItsTopicsAreInNoOtherExportAndAreReplacedByTheNextOne) {
  Export();
  const auto csv = ExportCsv(path_, Path("csv"), false);
  ASSERT_TRUE(csv.ok()) << csv.error().message;
  for (const ExportedFile& file : *csv)
    EXPECT_FALSE(file.topic.starts_with("/foxglove")) << file.topic;
  const auto again = ExportFoxglove(path_, Path("again"), "test", false);
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ(Bytes(again->path).size(), Bytes(path_).size());
}

TEST_F(FoxgloveTest, ARecordingWithNothingToDrawOrCutShortIsAnError) {
  WriteSampleRecording(Path("a.mcap"), true);
  const auto nothing = ExportFoxglove(Path("a.mcap"), Path("out"), "test", false);
  ASSERT_FALSE(nothing.ok());
  EXPECT_EQ(nothing.error().kind, ErrorKind::kInvalidData);
  EXPECT_THAT(nothing.error().message, HasSubstr("can be drawn"));
  WriteSceneRecording(Path("scene.mcap"));
  const std::string bytes = Bytes(Path("scene.mcap"));
  Save(Path("cut.mcap"), bytes.substr(0, bytes.size() / 2));
  const auto cut = ExportFoxglove(Path("cut.mcap"), Path("out"), "test", false);
  ASSERT_FALSE(cut.ok());
  EXPECT_THAT(cut.error().message, HasSubstr("repair"));
  EXPECT_TRUE(Bytes(Path("out/cut_foxglove.mcap")).empty());
}

}  // namespace
}  // namespace footing::log_client
