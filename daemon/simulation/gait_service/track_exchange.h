#pragma once

#include <memory>

#include "common/runtime/bounded_queue.h"
#include "daemon/simulation/engine/track_world.h"

namespace footing::gait_service {

/// How tracks come to the simulation thread and go back: it never allocates or frees. A track takes
/// effect with the first inputs that carry its number; it is queued before them.
struct TrackExchange {
  static constexpr std::size_t kMost = 4;  ///< On their way at one time.

  exchange::BoundedQueue<std::unique_ptr<engine::TrackWorld>> next{kMost};
  exchange::BoundedQueue<std::unique_ptr<engine::TrackWorld>> done{kMost};
};

}  // namespace footing::gait_service
