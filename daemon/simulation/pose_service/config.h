#pragma once

#include <cstdint>
#include <string>

#include "common/runtime/config.h"

namespace footing::pose_service {

/// Settings of the pose engine's service.
struct Config {
  std::string subject;        ///< Subject file; empty: nobody has been named.
  std::string mode = "best";  ///< "best" or "paper".
  std::int64_t lag_ms = 0;    ///< 0, 100 or 200.

  void Bind(config::Binder& binder);
};

/// Usage error that lists what there is when mode or lag is none of them.
Result<void> Check(const Config& config);

}  // namespace footing::pose_service
