#include "common/recording/tick_player.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>

#include "common/recording/recording_writer.h"
#include "common/runtime/timer.h"
#include "tests/common/temporary_folder.h"

namespace footing::playback {
namespace {

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
