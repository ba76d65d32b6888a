#include <gmock/gmock.h>
#include <google/protobuf/descriptor.pb.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "common/mcap/summary.h"
#include "common/mcap/walk.h"
#include "common/recording/mapped_file.h"
#include "common/recording/recorded_session.h"
#include "common/recording/recording_writer.h"
#include "common/recording/repair.h"
#include "common/recording/schema.h"
#include "common/units/instant.h"
#include "footing/v1/session.pb.h"
#include "tests/common/temporary_folder.h"

namespace footing::recording {
namespace {

using testing::HasSubstr;
using testing::Not;

class Recording : public testing::Test {
 protected:
  std::string Path(const std::string& name) const { return folder_.Path(name); }

  /// Sample k of device 3, received at k * 10 ms, on /footingd/motion, one a tick.
  void WriteMotion(const std::string& path, int ticks, bool of_a_server = false) {
    Result<RecordingWriter> writer = RecordingWriter::Create(path, {"test", false, {}});
    ASSERT_TRUE(writer.ok()) << writer.error().message;
    const mcap::TextMap session{{"server", "footingd"}, {"epoch", "7"}};
    if (of_a_server) {
      ASSERT_TRUE(writer->AddMetadata("session", session).ok());
    }
    for (int k = 0; k < ticks; ++k) {
      const std::int64_t time_ns = std::int64_t{10'000'000} * k;
      v1::MotionSamples motion;
      v1::MotionSample& sample = *motion.add_samples();
      sample.set_device(3);
      sample.set_received_ns(time_ns);
      sample.mutable_specific_force_mps2()->set_x(k * 0.25);
      ASSERT_TRUE(writer
                      ->Write("/footingd/motion", motion,
                              {time_ns, time_ns + 1, static_cast<std::uint32_t>(k)})
                      .ok());
    }
    ASSERT_TRUE(writer->Finish().ok());
  }

  static std::string Bytes(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  static void Save(const std::string& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
  }

  /// specific_force x of every message, read by the schema inside the file.
  static std::vector<double> Read(const std::string& bytes) {
    std::vector<double> values;
    SchemaPool pool;
    std::map<std::uint16_t, std::uint16_t> schema_of;
    mcap::Visitor visitor;
    visitor.schema = [&](const mcap::Schema& schema) { EXPECT_TRUE(pool.Add(schema).ok()); };
    visitor.channel = [&](const mcap::Channel& c) { schema_of[c.id] = c.schema_id; };
    visitor.message = [&](const mcap::Message& message) {
      const google::protobuf::Message* any =
          pool.Parse(schema_of[message.channel_id], message.data);
      ASSERT_NE(any, nullptr);
      v1::MotionSamples motion;
      ASSERT_TRUE(motion.ParseFromString(any->SerializeAsString()));
      values.push_back(motion.samples(0).specific_force_mps2().x());
    };
    EXPECT_TRUE(mcap::Walk(bytes, visitor, mcap::WalkMode::kStrict).complete);
    return values;
  }

  /// Repairs the file at `path` with one bit wrong in its middle.
  RepairReport RepairDamaged(const std::string& path) {
    std::string bytes = Bytes(path);
    bytes[bytes.size() / 2] ^= 1;
    Save(Path("damaged.mcap"), bytes);
    const auto report = Repair(Path("damaged.mcap"), Path("repaired.mcap"), "test", true);
    EXPECT_TRUE(report.ok());
    EXPECT_EQ(report->found.damaged_chunks, 1u);
    return *report;
  }

  struct Numbers {
    std::vector<std::uint32_t> ticks;
    std::vector<v1::Gap> gaps;
  };

  static Numbers NumbersOf(const std::string& bytes) {
    Numbers numbers;
    std::map<std::uint16_t, std::string> topics;
    mcap::Visitor visitor;
    visitor.channel = [&](const mcap::Channel& c) { topics[c.id] = c.topic; };
    visitor.message = [&](const mcap::Message& message) {
      if (topics[message.channel_id] != "/footingd/gaps") {
        numbers.ticks.push_back(message.sequence);
        return;
      }
      numbers.gaps.emplace_back();
      EXPECT_TRUE(numbers.gaps.back().ParseFromString(std::string(message.data)));
    };
    EXPECT_TRUE(mcap::Walk(bytes, visitor, mcap::WalkMode::kStrict).complete);
    return numbers;
  }

  test::TemporaryFolder folder_;
};

TEST_F(Recording, MessagesComeBackThroughTheSchemaInside) {
  WriteMotion(Path("a.mcap"), 5);
  EXPECT_THAT(Read(Bytes(Path("a.mcap"))), testing::ElementsAre(0, 0.25, 0.5, 0.75, 1));
}

TEST_F(Recording, SchemaHoldsItsImportsBeforeItself) {
  google::protobuf::FileDescriptorSet files;
  ASSERT_TRUE(files.ParseFromString(DescribeWithImports(*v1::Tick::descriptor())));
  std::vector<std::string> names;
  for (const auto& file : files.file()) {
    for (const std::string& import : file.dependency()) {
      EXPECT_THAT(names, testing::Contains(import)) << "imported by " << file.name();
    }
    names.push_back(file.name());
  }
  EXPECT_EQ(names.back(), "footing/v1/session.proto");
}

TEST_F(Recording, NeverOverwritesUnlessTold) {
  WriteMotion(Path("a.mcap"), 1);
  const Result<RecordingWriter> again =
      RecordingWriter::Create(Path("a.mcap"), {"test", false, {}});
  ASSERT_FALSE(again.ok());
  EXPECT_EQ(again.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(again.error().message, HasSubstr("--force"));
  EXPECT_TRUE(RecordingWriter::Create(Path("a.mcap"), {"test", true, {}}).ok());
}

TEST_F(Recording, ReplacesAnExistingOneAtItsFirstMessage) {
  WriteMotion(Path("a.mcap"), 100);
  const auto old_bytes = std::filesystem::file_size(Path("a.mcap"));
  auto writer = RecordingWriter::Create(Path("a.mcap"), {"test", true, {}});
  ASSERT_TRUE(writer.ok());
  ASSERT_TRUE(writer->AddMetadata("session", {{"server", "footingd"}}).ok());
  ASSERT_TRUE(writer->Attach("config.json", "application/json", "{}", 0).ok());
  ASSERT_TRUE(writer->Flush().ok());
  EXPECT_EQ(std::filesystem::file_size(Path("a.mcap")), old_bytes);
  ASSERT_TRUE(writer->Write("/footingd/gaps", v1::Gap(), {0, 0, 0}).ok());
  ASSERT_TRUE(writer->Finish().ok());
  const auto session = RecordedSession::Open(Path("a.mcap"));
  ASSERT_TRUE(session.ok());
  ASSERT_EQ(session->metadata().size(), 1u);
  EXPECT_EQ(session->metadata()[0].name, "session") << "of before the first message";
}

TEST_F(Recording, IsReadableByItsOwnerAlone) {
  WriteMotion(Path("a.mcap"), 1);
  EXPECT_EQ(std::filesystem::status(Path("a.mcap")).permissions(),
            std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
}

TEST_F(Recording, AnUnfinishedOneIsOnDiskUpToItsLastFlush) {
  Result<RecordingWriter> writer = RecordingWriter::Create(Path("a.mcap"), {"test", false, {}});
  ASSERT_TRUE(writer.ok());
  // A message every 10 ms: the chunk that spans 1 s closes at the 101st.
  for (int k = 0; k <= 100; ++k) {
    ASSERT_TRUE(writer->Write("/t", v1::Gap(), {std::int64_t{10'000'000} * k, 0, 0}).ok());
    EXPECT_EQ(writer->pending(), k < 100);
  }
  int on_disk = 0;
  mcap::Visitor visitor;
  visitor.message = [&](const mcap::Message&) { ++on_disk; };
  const mcap::WalkEnd end = mcap::Walk(Bytes(Path("a.mcap")), visitor, mcap::WalkMode::kSalvage);
  EXPECT_TRUE(end.cut);
  EXPECT_EQ(on_disk, 101);
}

TEST_F(Recording, RepairOfACutFileKeepsEveryCompleteMessageAndIsComplete) {
  WriteMotion(Path("whole.mcap"), 250);
  const std::string whole = Bytes(Path("whole.mcap"));
  std::size_t kept_before = 0;
  for (std::size_t cut = 8; cut < whole.size();
       cut += 331) {  // 331 is prime: any place in a record.
    Save(Path("cut.mcap"), whole.substr(0, cut));
    const auto report = Repair(Path("cut.mcap"), Path("repaired.mcap"), "test", true);
    ASSERT_TRUE(report.ok()) << report.error().message;
    const std::vector<double> values = Read(Bytes(Path("repaired.mcap")));
    ASSERT_EQ(values.size(), report->messages);
    ASSERT_GE(values.size(), kept_before);
    for (std::size_t k = 0; k < values.size(); ++k) ASSERT_EQ(values[k], 0.25 * double(k));
    kept_before = values.size();
    EXPECT_TRUE(mcap::ReadSummary(Bytes(Path("repaired.mcap"))).ok());
  }
  EXPECT_EQ(kept_before, 250u);
}

TEST_F(Recording, RepairOfAWholeFileSaysThatNothingWasWrong) {
  WriteMotion(Path("whole.mcap"), 30);
  const auto report = Repair(Path("whole.mcap"), Path("copy.mcap"), "test", false);
  ASSERT_TRUE(report.ok());
  EXPECT_TRUE(report->found.complete);
  EXPECT_EQ(report->messages, 30u);
  EXPECT_EQ(Bytes(Path("copy.mcap")), Bytes(Path("whole.mcap")));
}

TEST_F(Recording, RepairOfADamagedFileNamesTheTicksThatItLost) {
  WriteMotion(Path("whole.mcap"), 450, true);
  const RepairReport report = RepairDamaged(Path("whole.mcap"));
  const Numbers numbers = NumbersOf(Bytes(Path("repaired.mcap")));
  ASSERT_EQ(numbers.gaps.size(), 1u);
  const v1::Gap& gap = numbers.gaps[0];
  EXPECT_EQ(gap.reason(), v1::Gap::REASON_DAMAGED);
  EXPECT_GT(report.missing_ticks, 50u);
  EXPECT_EQ(gap.to_sequence() - gap.from_sequence() + 1, report.missing_ticks);
  EXPECT_EQ(numbers.ticks.size() + report.missing_ticks, 450u);
  for (const std::uint32_t tick : numbers.ticks) {
    EXPECT_TRUE(tick < gap.from_sequence() || tick > gap.to_sequence()) << tick;
  }
}

TEST_F(Recording, RepairAddsNothingToAFileThatIsOfNoServer) {
  WriteMotion(Path("whole.mcap"), 450);
  EXPECT_EQ(RepairDamaged(Path("whole.mcap")).missing_ticks, 0u);
  EXPECT_TRUE(NumbersOf(Bytes(Path("repaired.mcap"))).gaps.empty());
}

TEST_F(Recording, RepairNamesNoTicksWhereAServerStartedAgainOrSkippedSome) {
  Result<RecordingWriter> writer = RecordingWriter::Create(Path("whole.mcap"), {"test", false, {}});
  int written = 0;
  for (const int epoch : {1, 2}) {
    ASSERT_TRUE(writer->Flush().ok());
    ASSERT_TRUE(
        writer->AddMetadata("session", {{"server", "footingd"}, {"epoch", std::to_string(epoch)}})
            .ok());
    // The second start counts from 1 again, with other numbers; every third tick has nothing new.
    for (int k = 0; k < 150; ++k, ++written) {
      const std::int64_t time_ns = std::int64_t{10'000'000} * written;
      const auto number = static_cast<std::uint32_t>(epoch * 100 + k + k / 2);
      ASSERT_TRUE(
          writer->Write("/footingd/motion", v1::MotionSamples(), {time_ns, time_ns, number}).ok());
    }
  }
  ASSERT_TRUE(writer->Finish().ok());
  EXPECT_TRUE(NumbersOf(Bytes(Path("whole.mcap"))).gaps.empty());
  std::string bytes = Bytes(Path("whole.mcap"));
  const std::size_t second = bytes.find("session", bytes.find("session") + 1);
  bytes[second - 1200] ^= 1;  // In the last chunk of the first start.
  Save(Path("damaged.mcap"), bytes);
  const auto report = Repair(Path("damaged.mcap"), Path("repaired.mcap"), "test", true);
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(report->found.damaged_chunks, 1u);
  EXPECT_EQ(report->missing_ticks, 0u);
  EXPECT_TRUE(NumbersOf(Bytes(Path("repaired.mcap"))).gaps.empty());
}

TEST_F(Recording, RepairRefusesWhatIsNoRecordingAndItsOwnInput) {
  for (const char* bytes : {"time_s,x_mm\n", ""}) {
    Save(Path("text.mcap"), bytes);
    const auto no_mcap = Repair(Path("text.mcap"), Path("out.mcap"), "test", false);
    ASSERT_FALSE(no_mcap.ok());
    EXPECT_EQ(no_mcap.error().kind, ErrorKind::kInvalidData);
    EXPECT_FALSE(std::filesystem::exists(Path("out.mcap")));
  }
  WriteMotion(Path("a.mcap"), 1);
  const auto same = Repair(Path("a.mcap"), Path("a.mcap"), "test", true);
  ASSERT_FALSE(same.ok());
  EXPECT_EQ(same.error().kind, ErrorKind::kUsage);
}

TEST_F(Recording, ATextFileIsNoCaseForRepair) {
  Save(Path("notes.txt"), "day 1\n");
  const auto session = RecordedSession::Open(Path("notes.txt"));
  ASSERT_FALSE(session.ok());
  EXPECT_EQ(session.error().kind, ErrorKind::kInvalidData);
  EXPECT_THAT(session.error().message, HasSubstr("notes.txt is not a recording"));
  EXPECT_THAT(session.error().message, Not(HasSubstr("repair")));
}

TEST_F(Recording, ARateThatNoServerHasIsTheUsualOne) {
  const std::pair<const char*, double> rates[] = {{"50", 50},      {"0", 100},   {"-5", 100},
                                                  {"1e-300", 100}, {"inf", 100}, {"nan", 100}};
  for (const auto& [written, read] : rates) {
    const std::string path = Path(std::string(written) + ".mcap");
    auto writer = RecordingWriter::Create(path, {"test", false, {}});
    ASSERT_TRUE(
        writer->AddMetadata("session", {{"server", "footingd"}, {"tick_rate_hz", written}}).ok());
    ASSERT_TRUE(writer->Finish().ok());
    const auto session = RecordedSession::Open(path);
    ASSERT_TRUE(session.ok());
    EXPECT_EQ(session->servers()[0].tick_rate_hz, read) << written;
  }
}

TEST_F(Recording, ATimeToWhichNoClockComesIsRefused) {
  for (const std::int64_t time_ns : {kMostInstantNs + 1, std::int64_t{-1}}) {
    auto writer = RecordingWriter::Create(Path("a.mcap"), {"test", true, {}});
    ASSERT_TRUE(writer->Write("/footingd/motion", v1::MotionSamples(), {time_ns, 0, 1}).ok());
    ASSERT_TRUE(writer->Finish().ok());
    const auto session = RecordedSession::Open(Path("a.mcap"));
    ASSERT_FALSE(session.ok());
    EXPECT_EQ(session.error().kind, ErrorKind::kInvalidData);
    EXPECT_THAT(session.error().message, HasSubstr("no clock of a host"));
  }
}

TEST_F(Recording, SchemasThatMakeNoSenseAreRefused) {
  SchemaPool pool;
  const auto encoding = pool.Add({1, "a.B", "ros2msg", ""});
  ASSERT_FALSE(encoding.ok());
  EXPECT_THAT(encoding.error().message, HasSubstr("ros2msg"));
  EXPECT_FALSE(pool.Add({1, "a.B", "protobuf", "\xFF\xFF garbage"}).ok());
  EXPECT_FALSE(pool.Add({1, "a.B", "protobuf", ""}).ok());
  EXPECT_EQ(pool.Parse(1, ""), nullptr);
}

}  // namespace
}  // namespace footing::recording
