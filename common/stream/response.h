#pragma once

#include <vector>

#include "common/stream/character.h"
#include "common/stream/gait.h"

namespace footing::stream {

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
