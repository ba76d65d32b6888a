#include "clients/log/export_bids.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/clients/log/sample_recording.h"
#include "tests/clients/log/temporary_folder.h"

namespace footing::log_client {
namespace {

using testing::HasSubstr;

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

}  // namespace
}  // namespace footing::log_client
