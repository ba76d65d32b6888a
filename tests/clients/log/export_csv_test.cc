#include "clients/log/export_csv.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "common/recording/recording_writer.h"
#include "footing/v1/session.pb.h"
#include "tests/clients/log/sample_recording.h"
#include "tests/clients/log/temporary_folder.h"
#include "tests/common/made_recording.h"

namespace footing::log_client {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
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
