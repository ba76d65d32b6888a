#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "common/net/handshake.h"
#include "common/net/tick_queue.h"
#include "common/net/write_batch.h"

namespace footing::transport {

/// Buffers that one tick may take in a batch; a tick of more pieces is copied into one.
inline constexpr std::size_t kBuffersPerTick = 8;

/// Adds the frame of one tick: a head of this session's own, and the shared bytes of the channels
/// subscribed to. `head` says all but what the tick does. The batch has space for kBuffersPerTick.
void AddTick(const TickQueue::Entry& entry, const Subscription& subscription, TickHead head,
             WriteBatch& batch);

}  // namespace footing::transport
