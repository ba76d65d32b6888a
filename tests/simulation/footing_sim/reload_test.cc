#include "daemon/simulation/footing_sim/reload.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace footing::footing_sim {
namespace {

using ::testing::ElementsAre;

TEST(Reload, TakesTheLimitsOfSessionsAndSaysWhatNeedsARestart) {
  Config before, wanted;
  wanted.serving.sessions.max_log_sessions = 9;
  wanted.engine = "pose";
  std::vector<std::string> lines;
  const Config next =
      Reloaded(before, wanted, {}, [&](const std::string& line) { lines.push_back(line); });
  EXPECT_EQ(next.serving.sessions.max_log_sessions, 9);
  EXPECT_EQ(next.engine, "gait");
  EXPECT_THAT(lines, ElementsAre("config reloaded: max_log_sessions 64 -> 9",
                                 "config: takes effect after a restart: engine \"gait\" -> "
                                 "\"pose\""));
}

}  // namespace
}  // namespace footing::footing_sim
