#pragma once

#include <vector>

#include "clients/view/scene/update.h"

namespace footing::scene {

/// Where a response's time went, first to last.
struct ResponseStage {
  const char* name;
  double ms;
};
/// Empty when the stamps do not say.
std::vector<ResponseStage> ResponseTimes(const ResponseStages& response);

}  // namespace footing::scene
