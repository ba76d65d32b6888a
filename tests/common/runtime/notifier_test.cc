#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string>
#include <vector>

#include "common/runtime/service_manager.h"
#include "common/runtime/timer.h"

namespace footing::service_manager {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

/// The manager's side of sd_notify(3), with a watchdog of 100 ms: the kernel keeps ten messages
/// that nobody has read, and then the sender waits.
class NotifierTest : public testing::Test {
 protected:
  NotifierTest() : socket_(socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
    path_ = testing::TempDir() + "notify" + std::to_string(getpid());
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    path_.copy(name.sun_path, sizeof(name.sun_path) - 1);
    unlink(path_.c_str());
    EXPECT_EQ(bind(socket_, reinterpret_cast<sockaddr*>(&name), sizeof(name)), 0);
    setenv("NOTIFY_SOCKET", path_.c_str(), 1);
    setenv("WATCHDOG_USEC", "100000", 1);
    unsetenv("WATCHDOG_PID");
  }
  ~NotifierTest() override {
    unsetenv("NOTIFY_SOCKET");
    unsetenv("WATCHDOG_USEC");
    unlink(path_.c_str());
    close(socket_);
  }

  /// Messages to the manager in the next 0.2 s.
  std::vector<std::string> RunAndRead() {
    io_.restart();
    io_.run_for(std::chrono::milliseconds(200));
    std::vector<std::string> said;
    std::array<char, 1024> bytes{};
    for (ssize_t size = 0; (size = recv(socket_, bytes.data(), bytes.size(), 0)) > 0;) {
      said.emplace_back(bytes.data(), static_cast<std::size_t>(size));
    }
    return said;
  }

  boost::asio::io_context io_;
  std::string stuck_;
  Notifier notifier_{io_, [this] { return stuck_; }};

 private:
  int socket_;
  std::string path_;
};

TEST_F(NotifierTest, TheWatchdogIsFedTwiceInAnInterval) {
  notifier_.Ready("engine gait");
  const auto said = RunAndRead();
  ASSERT_FALSE(said.empty());
  EXPECT_EQ(said.front(), "READY=1\nSTATUS=engine gait");
  EXPECT_GE(std::count(said.begin(), said.end(), "WATCHDOG=1"), 3);
}

TEST_F(NotifierTest, TheWatchdogIsNotFedWhileAThreadIsStuckAndTheStatusNamesIt) {
  notifier_.Ready("engine gait");
  RunAndRead();
  stuck_ = "the thread of /dev/hidraw3";
  EXPECT_THAT(RunAndRead(), ElementsAre("STATUS=the thread of /dev/hidraw3 is stuck"));
  EXPECT_THAT(RunAndRead(), SizeIs(0));
  stuck_.clear();
  const auto said = RunAndRead();
  EXPECT_THAT(said, Contains("STATUS=engine gait"));
  EXPECT_THAT(said, Contains("WATCHDOG=1"));
}

TEST_F(NotifierTest, TheWatchdogIsNotFedWhileTheLoopStandsStill) {
  notifier_.Ready("engine gait");
  RunAndRead();
  usleep(200'000);  // Nothing runs the loop.
  io_.restart();
  std::size_t before = RunAndRead().size();
  EXPECT_LE(before, 6u) << "one late beat, then those of 0.2 s";
  notifier_.Stopping();
  EXPECT_THAT(RunAndRead(), ElementsAre("STOPPING=1"));
}

TEST_F(NotifierTest, ABeatThatIsDueWhenTheProgramStopsIsNotSent) {
  timer::Timer stop(io_);
  stop.expires_after({});
  stop.async_wait([this](const boost::system::error_code&) { notifier_.Stopping(); });
  notifier_.Ready("engine gait");
  usleep(60'000);  // Both have expired before the loop runs.
  const auto said = RunAndRead();
  EXPECT_THAT(said, Contains("STOPPING=1"));
  EXPECT_EQ(std::count(said.begin(), said.end(), "WATCHDOG=1"), 1) << "that of Ready";
}

TEST(ProgramEnd, ASignalOrTheTimeEndsTheProgram) {
  boost::asio::io_context io(1);
  std::string called;
  ProgramEnd end(io, [&] { called += "signal "; });
  end.After(3600, [&] { called += "late "; });
  end.After(0.001, [&] {
    called += "time ";
    EXPECT_FALSE(end.asked());
    std::raise(SIGTERM);
  });
  timer::Run(io);  // Returns when nothing is left to wait for.
  EXPECT_EQ(called, "time signal ");
  EXPECT_TRUE(end.asked());
}

TEST(ProgramEnd, WithoutATimeItWaitsForASignalUntilItIsCancelled) {
  boost::asio::io_context io(1);
  timer::Timer work(io);
  ProgramEnd end(io, [] { FAIL(); });
  end.After(0, [] { FAIL(); });
  work.After(std::chrono::milliseconds(5), [&] { end.cancel(); });
  timer::Run(io);
  EXPECT_FALSE(end.asked());
}

}  // namespace
}  // namespace footing::service_manager
