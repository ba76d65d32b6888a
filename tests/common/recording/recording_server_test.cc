#include <limits>

#include <gtest/gtest.h>
#include <unistd.h>
#include <boost/asio/io_context.hpp>

#include "common/base/units.h"
#include "common/recording/recording_server.h"
#include "common/recording/recording_writer.h"
#include "common/runtime/timer.h"
#include "footing/v1/session.pb.h"
#include "tests/common/temporary_folder.h"

namespace footing::playback {
namespace {

mcap::TextMap SessionOf(std::int64_t server_ns, std::int64_t recorder_ns) {
  return {{"address", "tcp:10.0.0.2:4711"},
          {"server_host_ns", std::to_string(server_ns)},
          {"recorder_host_ns", std::to_string(recorder_ns)}};
}

TEST(RecordedServerTest, SessionsAreKeptUpToTheLimit) {
  RecordedServer server;
  for (std::size_t k = 0; k <= kMostSessions; ++k) TakeSession(SessionOf(5, 2), server);
  EXPECT_EQ(server.welcomes.size(), kMostSessions);
  EXPECT_EQ(server.offset_ns, 3);
}

TEST(RecordedServerTest, TimesBeyondTheLimitAreLeftOut) {
  RecordedServer server;
  TakeSession(SessionOf(kMostInstantNs + 1, 0), server);
  EXPECT_TRUE(server.welcomes.empty());
  TakeSession(SessionOf(kMostInstantNs, -kMostInstantNs), server);
  EXPECT_EQ(server.offset_ns, 0);
  TakeClock({{"valid", "true"}, {"server_minus_recorder_ns", std::to_string(-kMostInstantNs - 1)}},
            server);
  EXPECT_FALSE(server.clock_measured);
}

TEST(ShiftStamps, MovesEveryInstantOfTheServersClockAndNothingElse) {
  v1::Tick tick;
  tick.set_host_ns(100);
  tick.set_sequence(7);
  v1::MotionSample& sample = *tick.mutable_motion()->add_samples();
  sample.set_received_ns(90);
  sample.set_sampled_ns(80);
  v1::RawReport& raw = *tick.mutable_raw()->add_reports();
  raw.set_received_ns(90);
  raw.set_true_ns(5);
  v1::SetupItem& item = *tick.mutable_setup()->add_rigs()->add_items();
  item.set_wall_time_ns(11);
  v1::Event& event = *tick.mutable_events()->add_events();
  event.mutable_response()->set_command_ns(70);
  v1::Tick moved = tick;
  ShiftStamps(moved, 1000);
  EXPECT_EQ(moved.host_ns(), 1100);
  EXPECT_EQ(moved.motion().samples(0).received_ns(), 1090);
  EXPECT_EQ(moved.motion().samples(0).sampled_ns(), 1080);
  EXPECT_EQ(moved.raw().reports(0).received_ns(), 1090);
  EXPECT_EQ(moved.raw().reports(0).true_ns(), 5);
  EXPECT_EQ(moved.setup().rigs(0).items(0).wall_time_ns(), 11);
  EXPECT_EQ(moved.events().events(0).response().command_ns(), 1070);
  EXPECT_EQ(moved.events().events(0).host_ns(), 0);  // Unknown stays unknown.
  ShiftStamps(moved, -1000);
  EXPECT_EQ(moved.SerializeAsString(), tick.SerializeAsString());
}

TEST(ShiftStamps, LeavesWhatNoClockComesTo) {
  constexpr std::int64_t kEnd = std::numeric_limits<std::int64_t>::max();
  v1::Tick tick;
  tick.set_host_ns(kEnd);
  tick.mutable_motion()->add_samples()->set_received_ns(-kEnd);
  tick.mutable_motion()->mutable_samples(0)->set_sampled_ns(80);
  ShiftStamps(tick, 1000);
  EXPECT_EQ(tick.host_ns(), kEnd);
  EXPECT_EQ(tick.motion().samples(0).received_ns(), -kEnd);
  EXPECT_EQ(tick.motion().samples(0).sampled_ns(), 1080);
}

TEST(TickPlayerTest, AfterAStopNothingIsPlayedThatWasDue) {
  boost::asio::io_context io;
  const test::TemporaryFolder folder;
  auto writer = recording::RecordingWriter::Create(folder.Path("empty.mcap"), {});
  ASSERT_TRUE(writer) << writer.error().message;
  ASSERT_TRUE(writer->Finish());
  const auto session = recording::RecordedSession::Open(folder.Path("empty.mcap"));
  ASSERT_TRUE(session) << session.error().message;
  bool ended = false;
  TickPlayer player(
      io, *session, {"footingd"},
      {[](std::size_t, const v1::Tick&) {}, [&](const Result<void>&) { ended = true; }});
  timer::Timer stop(io);
  stop.expires_after({});
  stop.async_wait([&](const boost::system::error_code&) { player.Stop(); });
  player.Start();   // Without a tick it ends 0.3 s later.
  usleep(350'000);  // Both have expired before the loop runs.
  io.run();
  EXPECT_FALSE(ended);
}

}  // namespace
}  // namespace footing::playback
