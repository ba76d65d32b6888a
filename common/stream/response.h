#pragma once

#include <cstdint>
#include <vector>

#include "common/stream/gait.h"

namespace footing::stream {

/// From the user's motion to the character's first visible answer: the stamps of one change of
/// gait, CLOCK_MONOTONIC of one host, in nanoseconds; 0 where unknown.
struct ResponseStages {
  Gait from = Gait::kUnspecified;
  Gait to = Gait::kUnspecified;
  std::int64_t report_received_ns = 0;
  std::int64_t decoded_ns = 0;
  std::int64_t features_computed_ns = 0;
  std::int64_t features_received_ns = 0;  ///< By footing-sim.
  std::int64_t command_ns = 0;            ///< The gait command changed.
  std::int64_t contact_ns = 0;            ///< The gait controller took it over.
  std::int64_t first_frame_ns = 0;        ///< The first frame that shows it was published.
};

/// Where a response's time went, first to last: "decode", "features", "transport", "command",
/// "contact" (the wait for the right contact), "frame".
struct ResponseStage {
  const char* name;
  double ms;
};
/// Empty when the stamps do not say.
std::vector<ResponseStage> ResponseTimes(const ResponseStages& response);

/// The stage that ends when the right foot is on the ground, whatever the sensors and the computer
/// do.
inline constexpr const char* kContactStage = "contact";

}  // namespace footing::stream
