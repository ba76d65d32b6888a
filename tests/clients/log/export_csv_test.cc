#include "clients/log/export_csv.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "common/recording/recording_writer.h"
#include "footing/v1/session.pb.h"
#include "tests/clients/log/sample_recording.h"
#include "tests/clients/log/temporary_folder.h"

namespace footing::log_client {
namespace {

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
