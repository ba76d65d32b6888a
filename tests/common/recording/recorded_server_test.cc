#include "common/recording/recorded_server.h"

#include <gtest/gtest.h>

#include "common/base/instant.h"

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

}  // namespace
}  // namespace footing::playback
