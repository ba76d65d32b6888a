#include "clients/log/export_xdf.h"

#include <gmock/gmock.h>
#include <xdf.h>

#include <cmath>
#include <sstream>
#include <string>

#include "clients/log/contents.h"
#include "clients/log/lsl.h"
#include "clients/log/lsl_in.h"
#include "common/recording/recording_writer.h"
#include "footing/v1/lsl.pb.h"
#include "footing/v1/session.pb.h"
#include "tests/clients/log/sample_recording.h"
#include "tests/clients/log/temporary_folder.h"
#include "tests/common/made_recording.h"

namespace footing::log_client {
namespace {

using testing::HasSubstr;

/// Read by libxdf, the reader of SigViewer: not ours.
class ExportXdfTest : public TemporaryFolder {
 protected:
  const Xdf::Stream& StreamNamed(const std::string& name) const {
    for (const Xdf::Stream& stream : xdf_.streams) {
      if (stream.info.name == name) return stream;
    }
    ADD_FAILURE() << "no stream " << name;
    return xdf_.streams.at(0);
  }
  static std::size_t ChannelNamed(const Xdf::Stream& stream, const std::string& label) {
    for (std::size_t i = 0; i < stream.info.channels.size(); ++i) {
      if (stream.info.channels[i].at("label") == label) return i;
    }
    ADD_FAILURE() << "no channel " << label;
    return 0;
  }

  Xdf xdf_;
};

TEST_F(ExportXdfTest, AnotherReaderFindsEverySampleWithItsTime) {
  WriteSampleRecording(Path("walk.mcap"), true);
  const auto exported = ExportXdf(Path("walk.mcap"), Path("out"), false);
  ASSERT_TRUE(exported.ok()) << exported.error().message;
  EXPECT_EQ(exported->path, Path("out/walk.xdf"));
  ASSERT_EQ(xdf_.load_xdf(exported->path), 0);
  ASSERT_EQ(xdf_.streams.size(), exported->streams.size());
  const Xdf::Stream& motion = StreamNamed("footingd/motion/1");
  EXPECT_EQ(motion.info.type, "Accelerometer");
  ASSERT_EQ(motion.time_stamps.size(), static_cast<std::size_t>(kSampleTicks));
  EXPECT_NEAR(motion.time_stamps[7], 0.07, 1e-9);  // Ticks of 10 ms.
  EXPECT_EQ(motion.info.sample_count, kSampleTicks);
  EXPECT_NEAR(motion.info.last_timestamp, 2.99, 1e-6);
  const std::size_t z = ChannelNamed(motion, "specific_force_mps2_z");
  EXPECT_FLOAT_EQ(motion.time_series[z][299], -9.80665f);
  EXPECT_EQ(motion.info.channels[z].at("unit"), "m/s2");
  const std::size_t count = ChannelNamed(motion, "report_count");
  EXPECT_EQ(motion.time_series[count][299], 299);
}

/// A board that has a role and its own time, one without either, and an event.
void WriteEventRecording(const std::string& path) {
  test::MadeRecording recording(path);
  recording.Begin("footingd");
  v1::Tick tick;
  tick.set_sequence(1);
  tick.set_host_ns(6'000'000'000);
  v1::DeviceStatus& status = *tick.mutable_status()->add_devices();
  status.set_device(7);
  status.set_role(v1::DEVICE_ROLE_LEFT_BOARD);
  recording.Add(tick);
  for (int i = 0; i < 3; ++i) {
    tick.Clear();
    tick.set_sequence(static_cast<std::uint64_t>(2 + i));
    tick.set_host_ns(7'000'000'000 + std::int64_t{10'000'000'000} * i);  // Boundaries in between.
    v1::BoardSample& left = *tick.mutable_boards()->add_samples();
    left.set_device(7);
    left.set_sampled_ns(tick.host_ns() - 4'000'000);
    left.set_total_n(100 + i);
    tick.mutable_boards()->add_samples()->set_device(8);
    for (const auto role : {v1::DEVICE_ROLE_LEFT_HAND, v1::DEVICE_ROLE_RIGHT_HAND}) {
      v1::HandSample& hand = *tick.mutable_hands()->add_samples();
      hand.set_rig("main");
      hand.set_role(role);
    }
    if (i == 2) {
      v1::Event& event = *tick.mutable_events()->add_events();
      event.set_kind(v1::Event::KIND_TASK);
      event.set_text("jump <high> & far");
    }
    recording.Add(tick);
  }
}

TEST_F(ExportXdfTest, EachDeviceIsAStreamUnderItsRoleAndEventsAreMarkers) {
  WriteEventRecording(Path("a.mcap"));
  const auto exported = ExportXdf(Path("a.mcap"), Path("out"), false);
  ASSERT_TRUE(exported.ok()) << exported.error().message;
  ASSERT_EQ(xdf_.load_xdf(exported->path), 0);
  const Xdf::Stream& left = StreamNamed("footingd/boards/left_board");
  ASSERT_EQ(left.time_stamps.size(), 3u);
  EXPECT_NEAR(left.time_stamps[1], 16.996, 1e-9);
  EXPECT_EQ(left.time_series[ChannelNamed(left, "total_n")][2], 102);
  const Xdf::Stream& other = StreamNamed("footingd/boards/8");
  EXPECT_NEAR(other.time_stamps.at(0), 7, 1e-9);
  EXPECT_EQ(StreamNamed("footingd/hands/main/left_hand").time_stamps.size(), 3u);
  EXPECT_EQ(StreamNamed("footingd/hands/main/right_hand").time_stamps.size(), 3u);
  EXPECT_EQ(left.info.clock_offsets.size() + left.clock_values.size(), 2u);
  EXPECT_EQ(StreamNamed("footingd/events").info.type, "Markers");
  ASSERT_EQ(xdf_.eventMap.size(), 1u);
  EXPECT_EQ(xdf_.eventMap[0].first.first, "KIND_TASK: jump <high> & far");
  EXPECT_NEAR(xdf_.eventMap[0].first.second, 27, 1e-9);
}

/// As a version wrote it that dated hands of one burst by their arrival: back by 2.2 ms. A board
/// sends a sample twice, a skeleton has several joints at once, two events are of one tick, and the
/// server's present state comes before the older ticks of its ring, one of which has it, too.
void WriteUnevenRecording(const std::string& path) {
  test::MadeRecording recording(path);
  recording.Begin("footingd", 6'000'000'000, 1'760'000'005'000'000'000);
  const auto tick_at = [](std::uint64_t sequence, std::int64_t ms) {
    v1::Tick tick;
    tick.set_sequence(sequence);
    tick.set_host_ns(ms * 1'000'000);
    v1::DeviceStatus& status = *tick.mutable_status()->add_devices();
    status.set_device(7);
    status.set_role(v1::DEVICE_ROLE_LEFT_BOARD);
    return tick;
  };
  recording.Add(tick_at(53, 7000));
  recording.Add(tick_at(103, 7500));
  for (std::uint64_t i = 0; i < 4; ++i) {
    v1::Tick tick = tick_at(50 + i, 6970 + 10 * static_cast<std::int64_t>(i));
    for (int k = 0; k < 2; ++k) {
      v1::HandSample& hand = *tick.mutable_hands()->add_samples();
      hand.set_rig("main");
      hand.set_role(v1::DEVICE_ROLE_LEFT_HAND);
      hand.set_tracker("camera");
      hand.set_confidence(1);
      hand.set_sampled_ns(tick.host_ns() - 5'000'000 - 2'200'000 * k);
      v1::HandSample& other = *tick.mutable_hands()->add_samples();
      other = hand;
      other.set_tracker("kinect");
      other.set_sampled_ns(tick.host_ns() - 30'000'000 + 100 * k);
      v1::HandSample& joint = *tick.mutable_hands()->add_samples();
      joint = other;
      joint.clear_role();
      joint.set_joint(k == 0 ? v1::BODY_JOINT_HEAD : v1::BODY_JOINT_NECK);
      joint.set_sampled_ns(tick.host_ns() - 30'000'000);
      v1::BoardSample& board = *tick.mutable_boards()->add_samples();
      board.set_device(7);
      board.set_report_count(2 * i + static_cast<std::uint64_t>(k));
      board.set_sampled_ns(tick.host_ns() - 3'000'000);
      tick.mutable_events()->add_events()->set_kind(v1::Event::KIND_TASK);
    }
    recording.Add(tick);
  }
}

TEST_F(ExportXdfTest, TheTimesOfEveryStreamRiseStrictly) {
  WriteUnevenRecording(Path("a.mcap"));
  const auto exported = ExportXdf(Path("a.mcap"), Path("out"), false);
  ASSERT_TRUE(exported.ok()) << exported.error().message;
  ASSERT_EQ(xdf_.load_xdf(exported->path), 0);
  for (const Xdf::Stream& stream : xdf_.streams) {
    for (std::size_t i = 1; i < stream.time_stamps.size(); ++i) {
      ASSERT_GT(stream.time_stamps[i], stream.time_stamps[i - 1]) << stream.info.name << " " << i;
    }
  }
  // A burst that goes back is mended; what each tracker sees keeps its own times.
  const Xdf::Stream& left = StreamNamed("footingd/hands/main/left_hand");
  ASSERT_EQ(left.time_stamps.size(), 8u);
  EXPECT_NEAR(left.time_stamps[0], 6.965, 1e-9);
  EXPECT_NEAR(left.time_stamps[1], 6.965 + 1e-6, 1e-9);
  EXPECT_NEAR(StreamNamed("footingd/hands/main/left_hand_kinect").time_stamps.at(2), 6.95, 1e-9);
  EXPECT_EQ(StreamNamed("footingd/hands/main/head").time_stamps.size(), 4u);
  // The present state waits for the ring's older ticks; the one that both have is there once.
  const auto& status = StreamNamed("footingd/status/left_board").time_stamps;
  ASSERT_EQ(status.size(), 5u);
  EXPECT_NEAR(status.front(), 6.97, 1e-9);
  EXPECT_NEAR(status.back(), 7.5, 1e-9);
  for (const ExportedStream& stream : exported->streams) {
    const bool mended = stream.name == left.info.name || stream.name == "footingd/events" ||
                        stream.name == "footingd/boards/left_board";
    EXPECT_EQ(stream.mended_times, mended ? 4u : 0u) << stream.name;
  }
}

TEST_F(ExportXdfTest, TheTimesOfTablesRiseStrictlyToo) {
  WriteUnevenRecording(Path("a.mcap"));
  const auto csv = ExportCsv(Path("a.mcap"), Path("csv"), false);
  ASSERT_TRUE(csv.ok()) << csv.error().message;
  for (const ExportedFile& file : *csv) {
    const std::uint64_t mended =
        file.topic == "/footingd/hands" || file.topic == "/footingd/boards" ? 4 : 0;
    EXPECT_EQ(file.mended_times, mended) << file.topic;
  }
  EXPECT_THAT(Bytes(Path("csv/footingd_boards.csv")), HasSubstr(",6967001000,"));
  const auto bids = ExportBids(Path("a.mcap"), Path("data"), {"01", "walk", false, "1.0"});
  ASSERT_TRUE(bids.ok()) << bids.error().message;
  ASSERT_FALSE(bids->tables.empty());
  for (const ExportedTable& table : bids->tables) {
    EXPECT_GE(table.samples, 2u) << table.path;  // Those from the first tick on.
    std::istringstream lines(Bytes(table.path));
    std::string line;
    double last_s = -1;
    while (std::getline(lines, line)) {
      const double time_s = std::stod(line);
      EXPECT_GT(time_s, last_s) << table.path;
      last_s = time_s;
    }
  }
}

/// A stream of another program, whose clock is 1000 s ahead of ours.
void WriteForeignRecording(const std::string& path) {
  auto writer = recording::RecordingWriter::Create(path, {});
  ASSERT_TRUE(writer.ok());
  lsl::Info info;
  info.name = "BioSemi";
  info.type = "EEG";
  info.format = lsl::Format::kFloat32;
  info.channels = 2;
  info.nominal_hz = 100;
  info.uid = "x";
  info.data_port = info.service_port = 16572;
  info.description = lsl::Describe({{"Cz", "microvolts"}, {"Oz", "microvolts"}}, "EEG", {});
  ASSERT_TRUE(writer
                  ->AddMetadata(lsl::kStreamMetadata,
                                {{"topic", "/lsl/BioSemi"}, {"info", lsl::FullInfo(info)}})
                  .ok());
  v1::LslClock clock;
  clock.set_time_s(1010);
  clock.set_correction_s(-1000);
  ASSERT_TRUE(writer->Write("/lsl/BioSemi/clock", clock, {1, 1, 0}).ok());
  for (int k = 0; k < 5; ++k) {
    v1::LslSamples samples;
    v1::LslSample& sample = *samples.add_samples();
    sample.set_time_s(1010 + 0.01 * k);
    sample.add_values(k);
    if (k < 4) sample.add_values(-k);  // The last one lacks a channel.
    ASSERT_TRUE(writer->Write("/lsl/BioSemi", samples, {2 + k, 2 + k, 0}).ok());
  }
  ASSERT_TRUE(writer->Finish().ok());
}

TEST_F(ExportXdfTest, AStreamOfAnotherProgramKeepsItsDescriptionAndClock) {
  WriteForeignRecording(Path("a.mcap"));
  const auto exported = ExportXdf(Path("a.mcap"), Path("out"), false);
  ASSERT_TRUE(exported.ok()) << exported.error().message;
  ASSERT_EQ(xdf_.load_xdf(exported->path), 0);
  const Xdf::Stream& stream = StreamNamed("BioSemi");
  EXPECT_EQ(stream.info.type, "EEG");
  EXPECT_EQ(stream.info.nominal_srate, 100);
  EXPECT_EQ(ChannelNamed(stream, "Oz"), 1u);
  ASSERT_EQ(stream.time_series.at(1).size(), 4u);
  EXPECT_EQ(stream.time_series[1][3], -3);
  ASSERT_EQ(stream.clock_values.size() + stream.info.clock_offsets.size(), 1u);
  ASSERT_EQ(stream.time_stamps.size(), 4u);
  EXPECT_NEAR(stream.time_stamps[3], 10.03, 1e-6);  // libxdf has added the clock's offset.
}

TEST_F(ExportXdfTest, MarkersAreTheirTextsAndTimesRise) {
  {
    test::MadeRecording recording(Path("a.mcap"));
    recording.Begin("footingd");
    const auto add = [&recording](std::uint64_t sequence, std::int64_t event_ns,
                                  v1::Event::Kind kind, const std::string& text) {
      v1::Tick tick;
      tick.set_sequence(sequence);
      tick.set_host_ns(static_cast<std::int64_t>(sequence) * 10'000'000);
      v1::Event& event = *tick.mutable_events()->add_events();
      event.set_kind(kind);
      event.set_host_ns(event_ns);
      event.set_text(text);
      if (text == "valued") event.mutable_marker()->set_value(2.5);
      recording.Add(tick);
    };
    add(10, 100'000'000, v1::Event::KIND_TASK, "jump");
    add(11, 95'000'000, v1::Event::KIND_MARKER, "stimulus");
    add(12, 111'000'000, v1::Event::KIND_MARKER, "valued");
  }
  const auto exported = ExportXdf(Path("a.mcap"), Path("out"), false);
  ASSERT_TRUE(exported.ok()) << exported.error().message;
  ASSERT_EQ(xdf_.load_xdf(exported->path), 0);
  ASSERT_EQ(xdf_.eventMap.size(), 3u);
  EXPECT_EQ(xdf_.eventMap[0].first.first, "stimulus");
  EXPECT_NEAR(xdf_.eventMap[0].first.second, 0.095, 1e-9);
  EXPECT_EQ(xdf_.eventMap[1].first.first, "KIND_TASK: jump");
  EXPECT_EQ(xdf_.eventMap[2].first.first, "valued 2.5");
}

TEST_F(ExportXdfTest, NeverOverwritesUnlessToldAndRefusesACutRecording) {
  WriteSampleRecording(Path("a.mcap"), true);
  ASSERT_TRUE(ExportXdf(Path("a.mcap"), Path("out"), false).ok());
  EXPECT_EQ(ExportXdf(Path("a.mcap"), Path("out"), false).error().kind, ErrorKind::kUsage);
  EXPECT_TRUE(ExportXdf(Path("a.mcap"), Path("out"), true).ok());
  const std::string whole = Bytes(Path("a.mcap"));
  Save(Path("cut.mcap"), whole.substr(0, whole.size() - 1));
  const auto cut = ExportXdf(Path("cut.mcap"), Path("cut"), false);
  ASSERT_FALSE(cut.ok());
  EXPECT_THAT(cut.error().message, HasSubstr("repair"));
  EXPECT_FALSE(std::filesystem::exists(Path("cut")));
}

}  // namespace
}  // namespace footing::log_client
