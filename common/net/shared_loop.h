#pragma once

#include <boost/asio/post.hpp>
#include <functional>
#include <memory>
#include <utility>

#include "common/net/socket.h"
#include "common/net/turn_queue.h"
#include "common/net/write_batch.h"

namespace footing::transport {

/// What the connections of one thread share: empty batches, and the line in which each gets a small
/// piece of its work done. Without the line a connection does its work as it comes.
struct SharedLoop {
  std::shared_ptr<BatchPool> pool = std::make_shared<BatchPool>();
  std::shared_ptr<TurnQueue> turns;

  /// Calls `work` later, when its turn comes.
  void InTurn(const Socket::executor_type& executor, std::function<void()> work) const {
    if (!turns) return boost::asio::post(executor, std::move(work));
    turns->Add([work = std::move(work)] { return work(), false; });
  }
};

}  // namespace footing::transport
