#include "common/net/turn_queue.h"

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <memory>

namespace footing::transport {
namespace {

TEST(TurnQueue, WhatWaitsGoesWithTheLoopThoughItHoldsTheQueue) {
  std::weak_ptr<TurnQueue> left;
  std::weak_ptr<int> held;
  for (int polls = 0; polls < 4; ++polls) {  // Waiting for the first turn, then for a later one.
    {
      boost::asio::io_context io;
      const auto turns = std::make_shared<TurnQueue>(io.get_executor());
      const auto connection = std::make_shared<int>();
      left = turns;
      held = connection;
      turns->Add([turns, connection] { return true; });
      for (int i = 0; i < polls; ++i) io.run_one();
      EXPECT_EQ(turns->waiting(), 1u);
    }
    EXPECT_TRUE(held.expired()) << polls;
    EXPECT_TRUE(left.expired()) << polls;
  }
}

}  // namespace
}  // namespace footing::transport
