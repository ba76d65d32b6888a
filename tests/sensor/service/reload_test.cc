#include "daemon/sensor/service/reload.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sensor/service/fixture.h"

namespace footing::sensor {
namespace {

using ::testing::ElementsAre;

TEST(Reload, TakesWhatNeedsNoRestartAndSaysWhatDoes) {
  Config before, wanted;
  wanted.stale_after_s = 2;
  wanted.sessions.max_sessions = 9;
  wanted.default_rig = "left";
  wanted.tick_rate_hz = 50;
  wanted.roles = {{"00:1f", "main/left_hand"}};
  std::vector<std::string> lines;
  const Config next =
      Reloaded(before, wanted, {}, [&](const std::string& line) { lines.push_back(line); });
  EXPECT_EQ(next.stale_after_s, 2);
  EXPECT_EQ(next.sessions.max_sessions, 9);
  EXPECT_EQ(next.default_rig, "left");
  EXPECT_EQ(next.tick_rate_hz, 100);
  EXPECT_TRUE(next.roles.empty());
  EXPECT_THAT(lines,
              ElementsAre("config reloaded: default_rig \"main\" -> \"left\", stale_after_s 0.5 -> "
                          "2.0, max_sessions 256 -> 9",
                          "config: takes effect after a restart: roles {} -> "
                          "{\"00:1f\":\"main/left_hand\"}, tick_rate_hz 100.0 -> 50.0"));
}

TEST(Reload, SaysWhichFilesHaveAnotherContent) {
  Config wanted;
  wanted.access.clients_file = "/etc/footing/clients";
  std::vector<std::string> lines;
  const Config next = Reloaded({}, wanted, {"token_file", "clients_file"},
                               [&](const std::string& line) { lines.push_back(line); });
  EXPECT_EQ(next.access.clients_file, "/etc/footing/clients");
  EXPECT_THAT(lines, ElementsAre("config reloaded: clients_file \"\" -> \"/etc/footing/clients\", "
                                 "contents of token_file, contents of clients_file"));
}

TEST(Reload, HoldsForADeviceThatIsThere) {
  Bench bench;
  bench.Attach(virtual_devices::Wiimote(1), "a");
  bench.Advance(0.5);
  bench.silent = true;
  bench.Advance(0.8);
  EXPECT_EQ(bench.StatusOf("a").state, stream::DeviceState::kStale) << "after 0.5 s";
  Config wanted;
  wanted.stale_after_s = 2;
  bench.hub().Reload(Reloaded({}, wanted, {}, [](const std::string&) {}));
  bench.Advance(0.1);
  EXPECT_EQ(bench.StatusOf("a").state, stream::DeviceState::kLive);
  bench.Advance(1.5);
  EXPECT_EQ(bench.StatusOf("a").state, stream::DeviceState::kStale) << "after 2 s";
}

TEST(Reload, SaysWhenNothingHasChanged) {
  std::vector<std::string> lines;
  Reloaded({}, {}, {}, [&](const std::string& line) { lines.push_back(line); });
  EXPECT_THAT(lines, ElementsAre("config reloaded: nothing has changed"));
}

}  // namespace
}  // namespace footing::sensor
