#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "common/recording/mcap_reader.h"
#include "common/recording/recording_writer.h"
#include "common/recording/repair.h"
#include "footing/v1/session.pb.h"
#include "tests/common/temporary_folder.h"

namespace footing::recording {

class Recording : public testing::Test {
 protected:
  std::string Path(const std::string& name) const { return folder_.Path(name); }

  /// Sample k of device 3, received at k * 10 ms, on /footingd/motion, one a tick.
  void WriteMotion(const std::string& path, int ticks, bool of_a_server = false,
                   bool compress = false) {
    WriterSettings settings{"test", false, {}};
    settings.chunks.compress = compress;
    Result<RecordingWriter> writer = RecordingWriter::Create(path, settings);
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

}  // namespace footing::recording
