#include "daemon/sensor/setup/state_directory.h"

#include <gtest/gtest.h>

#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <functional>
#include <semaphore>
#include <vector>

#include "common/runtime/timer.h"

namespace footing::setup {
namespace {

/// A disk that takes each write when the test says so.
class DiskWriterTest : public testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& content) {
    let_through_.acquire();
    written_.push_back(name + "=" + content);
    return name == "bad" ? "the disk is full" : "";
  }
  /// Lets one write through.
  void Open() { let_through_.release(); }
  bool RunUntil(const std::function<bool()>& done) {
    io_.restart();
    return timer::RunUntil(io_, done, 5, [] { return false; }) == timer::Waited::kDone;
  }

  boost::asio::io_context io_;
  std::counting_semaphore<> let_through_{0};
  std::vector<std::string> written_;
  std::vector<std::string> problems_;
  std::optional<DiskWriter> disk_{
      std::in_place, io_,
      [this](const std::string& name, const std::string& content) { return Write(name, content); },
      [this](const std::string& problem) { problems_.push_back(problem); }};
};

TEST_F(DiskWriterTest, TheLoopGoesOnWhileTheDiskDoesNot) {
  bool written = false;
  disk_->Save("tares", "1");
  disk_->OnWritten([&](const std::string&) { written = true; });
  int ticks = 0;
  boost::asio::steady_timer tick(io_);
  std::function<void()> next = [&] {
    tick.expires_after(std::chrono::milliseconds(1));
    tick.async_wait([&](const boost::system::error_code& error) {
      if (error) return;
      ++ticks;
      next();
    });
  };
  next();
  EXPECT_TRUE(RunUntil([&] { return ticks == 20; }));
  EXPECT_FALSE(written) << "before it is on the disk";
  EXPECT_EQ(disk_->Waiting("tares"), "1");
  Open();
  EXPECT_TRUE(RunUntil([&] { return written; }));
  tick.cancel();
  EXPECT_EQ(written_, std::vector<std::string>{"tares=1"});
  EXPECT_EQ(disk_->Waiting("tares"), std::nullopt);
}

TEST_F(DiskWriterTest, AFloodOfOneTextIsWrittenTwiceAndTheOrderStays) {
  disk_->Save("roles", "0");
  for (int i = 1; i < 1000; ++i) disk_->Save("roles", std::to_string(i));
  disk_->Save("tares", "x");
  std::vector<std::string> done;
  disk_->OnWritten([&](const std::string&) { done = written_; });
  EXPECT_EQ(disk_->Waiting("roles"), "999");
  EXPECT_EQ(disk_->last_save(), 1001u);
  for (int i = 0; i < 3; ++i) {
    Open();
    ASSERT_TRUE(RunUntil([&] { return problems_.size() == static_cast<std::size_t>(i + 1); }));
  }
  EXPECT_EQ(done, (std::vector<std::string>{"roles=0", "roles=999", "tares=x"}));
}

TEST_F(DiskWriterTest, WhoWaitsLearnsWhatWentWrong) {
  std::vector<std::string> answers;
  disk_->Save("bad", "1");
  disk_->OnWritten([&](const std::string& problem) { answers.push_back(problem); });
  Open();
  ASSERT_TRUE(RunUntil([&] { return answers.size() == 1; }));
  disk_->Save("good", "1");
  disk_->OnWritten([&](const std::string& problem) { answers.push_back(problem); });
  Open();
  ASSERT_TRUE(RunUntil([&] { return answers.size() == 2; }));
  EXPECT_EQ(answers, (std::vector<std::string>{"the disk is full", ""}));
  EXPECT_EQ(problems_, (std::vector<std::string>{"the disk is full", ""}));
}

TEST_F(DiskWriterTest, WithNothingToWriteItIsDoneAtOnceButNotFromWithin) {
  bool done = false;
  disk_->OnWritten([&](const std::string&) { done = true; });
  EXPECT_FALSE(done);
  EXPECT_TRUE(RunUntil([&] { return done; }));
}

TEST_F(DiskWriterTest, WhatWaitsAtTheEndIsWritten) {
  disk_->Save("roles", "1");
  disk_->Save("tares", "2");
  Open();
  Open();
  disk_.reset();
  EXPECT_EQ(written_, (std::vector<std::string>{"roles=1", "tares=2"}));
}

}  // namespace
}  // namespace footing::setup
