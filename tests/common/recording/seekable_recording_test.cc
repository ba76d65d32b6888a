#include "common/recording/seekable_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "common/base/units.h"
#include "common/recording/recording_writer.h"
#include "tests/common/temporary_folder.h"

namespace footing::playback {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::int64_t kMs = 1'000'000;
const std::vector<std::string> kNames{"footing-sim", "footingd"};
const std::set<std::string> kChannels{"characters", "events", "status", "motion"};

class SeekableRecordingTest : public ::testing::Test {
 protected:
  void Create() {
    auto created = recording::RecordingWriter::Create(path_, {"test", true, {}});
    ASSERT_TRUE(created.ok());
    writer_.emplace(std::move(*created));
  }
  void Session(const std::string& server, const std::string& address, std::int64_t server_ns,
               std::int64_t recorder_ns) {
    ASSERT_TRUE(writer_->AddMetadata("session", {{"server", server},
                                                 {"address", address},
                                                 {"server_host_ns", std::to_string(server_ns)},
                                                 {"recorder_host_ns", std::to_string(recorder_ns)},
                                                 {"server_wall_time_ns", "1700000000000000000"}}));
  }
  void Frame(std::int64_t host_ns, std::int64_t recorded_ns, std::uint32_t sequence) {
    v1::CharacterFrame frame;
    frame.set_step(static_cast<std::uint64_t>(sequence));
    ASSERT_TRUE(writer_->Write("/footing-sim/characters", frame, {host_ns, recorded_ns, sequence}));
  }
  void Motion(std::int64_t host_ns, std::int64_t recorded_ns, std::uint32_t sequence) {
    v1::MotionSamples motion;
    motion.add_samples()->set_device(sequence);
    ASSERT_TRUE(writer_->Write("/footingd/motion", motion, {host_ns, recorded_ns, sequence}));
  }
  Result<SeekableRecording> Opened() {
    EXPECT_TRUE(writer_->Finish());
    return SeekableRecording::Open(path_, kNames, kChannels);
  }
  /// Opens it with other bytes; `change` gets them and the chunks.
  template <typename Change>
  Result<SeekableRecording> OpenedWith(Change change) {
    EXPECT_TRUE(writer_->Finish());
    std::ifstream whole(path_, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(whole), {}};
    const auto summary = mcap::ReadSummary(bytes);
    EXPECT_TRUE(summary.ok());
    change(bytes, summary->chunks);
    std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes;
    return SeekableRecording::Open(path_, kNames, kChannels);
  }

  test::TemporaryFolder folder_;
  std::string path_ = folder_.Path("seek.mcap");
  std::optional<recording::RecordingWriter> writer_;
};

std::vector<std::int64_t> TimesOf(const std::vector<PlacedTick>& ticks) {
  std::vector<std::int64_t> times_ms;
  for (const PlacedTick& placed : ticks) times_ms.push_back(placed.time_ns / kMs);
  return times_ms;
}

TEST_F(SeekableRecordingTest, TicksOfBothServersComeByTimeWithTheirChannels) {
  Create();
  for (std::uint32_t k = 0; k < 300; ++k) {
    Frame(k * 20 * kMs, k * 20 * kMs + 3 * kMs, k);
    Motion((k * 20 + 5) * kMs, (k * 20 + 6) * kMs, k);
  }
  auto recording = Opened();
  ASSERT_TRUE(recording.ok()) << recording.error().message;
  EXPECT_EQ(recording->first_ns(), 0);
  EXPECT_EQ(recording->last_ns(), (299 * 20 + 5) * kMs);
  EXPECT_EQ(recording->Limits(), "");
  const auto ticks = recording->Ticks(3000 * kMs, 3040 * kMs);
  EXPECT_THAT(TimesOf(ticks), ElementsAre(3000, 3005, 3020, 3025));
  EXPECT_EQ(ticks[0].tick.characters().step(), 150u);
  EXPECT_EQ(ticks[0].delay_ns, 3 * kMs);
  EXPECT_EQ(ticks[1].tick.motion().samples(0).device(), 150u);
  EXPECT_FALSE(ticks[1].tick.has_characters());
  EXPECT_EQ(ticks[1].server, 1u);
}

TEST_F(SeekableRecordingTest, TheLastMessageBeforeAnInstantIsFound) {
  Create();
  for (std::uint32_t k = 0; k < 300; ++k) {
    Frame((1000 + k * 20) * kMs, 0, k);
    if (k == 100) Motion(3000 * kMs, 0, k);
  }
  auto recording = Opened();
  ASSERT_TRUE(recording.ok());
  const auto last = [&](std::size_t server, const char* channel, std::int64_t at_ms, bool next) {
    const auto found = recording->LastOf(server, channel, at_ms * kMs, next);
    return found ? found->time_ns / kMs : -1;
  };
  EXPECT_EQ(last(0, "characters", 3019, false), 3000);
  EXPECT_EQ(last(0, "characters", 3020, false), 3020);
  EXPECT_EQ(last(0, "characters", 999, false), -1);
  EXPECT_EQ(last(0, "characters", 999, true), 1000);
  EXPECT_EQ(last(1, "motion", 6000, false), 3000);
  EXPECT_EQ(last(1, "motion", 2999, true), 3000);
  EXPECT_EQ(last(1, "status", 6000, true), -1);
}

TEST_F(SeekableRecordingTest, RefillsAreInTheirPlaceAndWhatCameTwiceComesOnce) {
  Create();
  // The recorder connects at 2 s and first gets the second before.
  Session("footing-sim", "unix:/a", 2000 * kMs, 2000 * kMs);
  for (std::uint32_t k = 50; k < 150; ++k) Frame(k * 20 * kMs, std::max(2001u, k * 20) * kMs, k);
  for (std::uint32_t k = 140; k < 150; ++k) Frame(k * 20 * kMs, 3100 * kMs, k);
  auto recording = Opened();
  ASSERT_TRUE(recording.ok());
  EXPECT_EQ(recording->Ticks(0, 10'000 * kMs).size(), 100u);
  EXPECT_FALSE(recording->Ticks(1980 * kMs, 2000 * kMs)[0].live);
  EXPECT_TRUE(recording->Ticks(2020 * kMs, 2040 * kMs)[0].live);
  EXPECT_EQ(recording->wall_minus_clock_ns(), 1'700'000'000'000'000'000 - 2000 * kMs);
}

TEST_F(SeekableRecordingTest, ServersOfOtherHostsAreOnTheRecordersClock) {
  Create();
  const std::int64_t offset_ns = 5'000'000 * kMs;
  Session("footing-sim", "tcp:10.0.0.2:4711", offset_ns, 0);
  for (std::uint32_t k = 0; k < 100; ++k) {
    Frame(offset_ns + k * 20 * kMs, (k * 20 + 4) * kMs, k);
    Motion(k * 20 * kMs, k * 20 * kMs, k);
  }
  ASSERT_TRUE(
      writer_->AddMetadata("clock", {{"server", "footing-sim"},
                                     {"address", "tcp:10.0.0.2:4711"},
                                     {"valid", "true"},
                                     {"server_minus_recorder_ns", std::to_string(offset_ns)}}));
  auto recording = Opened();
  ASSERT_TRUE(recording.ok());
  EXPECT_EQ(recording->first_ns(), 0);
  EXPECT_EQ(recording->last_ns(), 99 * 20 * kMs);
  const auto ticks = recording->Ticks(1000 * kMs, 1001 * kMs);
  ASSERT_EQ(ticks.size(), 2u);
  EXPECT_EQ(ticks[0].offset_ns, offset_ns);
  EXPECT_EQ(ticks[0].delay_ns, 4 * kMs);
}

TEST_F(SeekableRecordingTest, WithoutAMeasuredClockTheSessionSaysHowTheClocksStand) {
  // A killed recorder writes no "clock"; one that never measured it says that it is not valid.
  for (const bool killed : {true, false}) {
    Create();
    const std::int64_t offset_ns = 5'000'000 * kMs;
    Session("footing-sim", "tcp:10.0.0.2:4711", offset_ns + 100 * kMs, 100 * kMs);
    Session("footingd", "unix:/a", 60 * kMs, 100 * kMs);
    Frame(offset_ns + 200 * kMs, 203 * kMs, 1);
    Motion(210 * kMs, 211 * kMs, 1);
    const mcap::TextMap clock{{"server", "footing-sim"}, {"valid", "false"}};
    ASSERT_TRUE(killed || writer_->AddMetadata("clock", clock).ok());
    auto recording = Opened();
    ASSERT_TRUE(recording.ok()) << recording.error().message;
    EXPECT_EQ(recording->first_ns(), 200 * kMs);
    EXPECT_EQ(recording->last_ns(), 210 * kMs);
  }
}

TEST_F(SeekableRecordingTest, AMeasuredClockGoesBeforeTheSessions) {
  Create();
  const mcap::TextMap clock{{"server", "footing-sim"},
                            {"address", "tcp:10.0.0.2:4711"},
                            {"valid", "true"},
                            {"server_minus_recorder_ns", std::to_string(3000 * kMs)}};
  ASSERT_TRUE(writer_->AddMetadata("clock", clock));
  Session("footing-sim", "tcp:10.0.0.2:4711", 2990 * kMs, 0);
  Frame(3500 * kMs, 510 * kMs, 1);
  auto recording = Opened();
  ASSERT_TRUE(recording.ok());
  EXPECT_EQ(recording->first_ns(), 500 * kMs);
}

TEST_F(SeekableRecordingTest, DamagedChunksAtTheEndsDoNotHideTheRest) {
  Create();
  for (std::uint32_t k = 0; k < 250; ++k) Frame(k * 20 * kMs, k * 20 * kMs, k);
  auto recording = OpenedWith([](std::string& bytes, const auto& chunks) {
    ASSERT_GT(chunks.size(), 3u);
    bytes[chunks.front().chunk_offset] = '\x7f';
    bytes[chunks.back().chunk_offset] = '\x7f';
  });
  ASSERT_TRUE(recording.ok()) << recording.error().message;
  // A chunk holds the 51 frames of 1 s: the last one begins with frame 204.
  EXPECT_EQ(recording->first_ns() / kMs, 51 * 20);
  EXPECT_EQ(recording->last_ns() / kMs, 203 * 20);
  EXPECT_THAT(recording->Limits(), HasSubstr("2 damaged chunks"));
}

TEST_F(SeekableRecordingTest, WhatIsVisitedIsWhatPlays) {
  Create();
  for (std::uint32_t k = 0; k < 250; ++k) Frame(k * 20 * kMs, k * 20 * kMs, k);
  auto recording = OpenedWith([](std::string& bytes, const auto& chunks) {
    // Damages the last message of one chunk by a byte, and the message index of another one.
    bytes[chunks[1].chunk_offset + chunks[1].chunk_length - 1] ^= 1;
    bytes[chunks[2].message_index_offsets.begin()->second] ^= 0x40;
  });
  ASSERT_TRUE(recording.ok());
  std::vector<std::int64_t> visited_ns;
  recording->Visit(0, "characters",
                   [&](const PlacedTick& placed) { visited_ns.push_back(placed.time_ns); });
  EXPECT_EQ(visited_ns.size(), 199u);
  std::vector<std::int64_t> played_ns;
  for (const PlacedTick& placed : recording->Ticks(0, 5000 * kMs)) {
    played_ns.push_back(placed.time_ns);
  }
  EXPECT_EQ(visited_ns, played_ns);
  // The frame before the damaged chunk, not one within it.
  EXPECT_EQ(recording->LastOf(0, "characters", 2000 * kMs)->time_ns, 1000 * kMs);
  EXPECT_THAT(recording->Limits(), HasSubstr("1 damaged chunks"));
}

TEST_F(SeekableRecordingTest, TimesThatCouldOverflowAreLeftOut) {
  Create();
  for (std::uint32_t k = 0; k < 50; ++k) Frame(k * 20 * kMs, k * 20 * kMs, k);
  // The chunk of such a message is left out.
  ASSERT_TRUE(writer_->Flush());
  Frame(kMostInstantNs + 1, 1000 * kMs, 50);
  ASSERT_TRUE(writer_->Flush());
  Frame(-1, 1000 * kMs, 51);
  ASSERT_TRUE(writer_->Flush());
  Frame(10'000 * kMs, kMostInstantNs + 1, 52);
  auto recording = Opened();
  ASSERT_TRUE(recording.ok());
  EXPECT_EQ(recording->first_ns(), 0);
  EXPECT_EQ(recording->last_ns(), 49 * 20 * kMs);
  EXPECT_THAT(recording->Limits(), HasSubstr("3 damaged chunks"));
}

TEST_F(SeekableRecordingTest, MessagesBeyondTheLimitOfSizeAreLeftOut) {
  Create();
  Frame(0, 0, 0);
  ASSERT_TRUE(writer_->Flush());
  v1::Events events;
  events.add_events()->set_text(std::string(std::size_t{64} << 20, 'a'));
  ASSERT_TRUE(writer_->Write("/footing-sim/events", events, {5000 * kMs, 5000 * kMs, 1}));
  auto recording = Opened();
  ASSERT_TRUE(recording.ok());
  EXPECT_EQ(recording->last_ns(), 0);
  EXPECT_FALSE(recording->LastOf(0, "events", 5000 * kMs));
}

TEST_F(SeekableRecordingTest, EveryTickIsVisitedOnce) {
  Create();
  for (std::uint32_t k = 0; k < 100; ++k) Frame(k * 20 * kMs, k * 20 * kMs, k);
  // Sent again by a resume; the last one is another tick of the same instant.
  for (std::uint32_t k = 90; k < 100; ++k) Frame(k * 20 * kMs, 2100 * kMs, k);
  Frame(99 * 20 * kMs, 2100 * kMs, 100);
  auto recording = Opened();
  ASSERT_TRUE(recording.ok());
  std::vector<std::uint64_t> steps;
  recording->Visit(0, "characters", [&](const PlacedTick& placed) {
    steps.push_back(placed.tick.characters().step());
  });
  ASSERT_EQ(steps.size(), 101u);
  EXPECT_EQ(steps[99], 99u);
  EXPECT_EQ(steps[100], 100u);
}

TEST_F(SeekableRecordingTest, NothingToPlayIsAnError) {
  Create();
  ASSERT_TRUE(writer_->Write("/footing-camera/status", v1::DeviceStatusList(), {1, 1, 1}));
  const auto recording = Opened();
  ASSERT_FALSE(recording.ok());
  EXPECT_EQ(recording.error().kind, ErrorKind::kInvalidData);
  EXPECT_THAT(recording.error().message, HasSubstr("no ticks of footing-sim or footingd"));
  EXPECT_FALSE(SeekableRecording::Open("/nowhere", kNames, kChannels).ok());
}

}  // namespace
}  // namespace footing::playback
