#pragma once

#include <memory>
#include <stdexcept>

#include "clients/stream/body_stage.h"

namespace footing::stream_client {

/// MakeStage() of what a test is sure of; throws its message otherwise.
inline std::shared_ptr<const Stage> MadeStage(const StageOptions& options) {
  const auto made = MakeStage(options);
  if (!made) throw std::runtime_error(made.error().message);
  return *made;
}

}  // namespace footing::stream_client
