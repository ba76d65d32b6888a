#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <string>
#include <thread>
#include <utility>

#include "common/runtime/clock.h"

namespace footing::timer {

/// While it lives, the calling thread has simulated time. What has timers is made after it and ends
/// before it.
class SimulatedTime {
 public:
  SimulatedTime() {
    std::string folder = "/tmp/footing-time-XXXXXX";
    EXPECT_NE(::mkdtemp(folder.data()), nullptr);
    auto keeper = clock::Timekeeper::Listen(folder + "/time", 0);
    EXPECT_TRUE(keeper);
    auto follower = clock::Follower::Connect(folder + "/time");
    EXPECT_TRUE(follower);
    keeper_ = std::thread([keeper = std::move(keeper).value()]() mutable {
      EXPECT_TRUE(keeper.AwaitFollower(10, [] { return false; }));
      while (keeper.followers() > 0 && keeper.GiveTurn()) {
      }
    });
    clock::Follow(std::move(follower).value());
    std::filesystem::remove_all(folder);
  }
  ~SimulatedTime() {
    clock::Follow(nullptr);
    keeper_.join();
  }
  SimulatedTime(const SimulatedTime&) = delete;
  SimulatedTime& operator=(const SimulatedTime&) = delete;

 private:
  std::thread keeper_;
};

}  // namespace footing::timer
