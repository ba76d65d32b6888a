#include "daemon/simulation/pose_service/config.h"

namespace footing::pose_service {

void Config::Bind(config::Binder& binder) {
  binder.Text("subject", subject,
              "Subject file of the pose engine: code, height_m, mass_kg, foot_length_m");
  binder.Text("mode", mode, "Reconstruction mode of the pose engine: best or paper");
  binder.Integer("lag_ms", lag_ms, 0, 200,
                 "Output delay of the pose engine, ms: 0, 100 or 200; longer is more accurate");
}

Result<void> Check(const Config& config) {
  if (config.mode != "best" && config.mode != "paper") {
    return UsageError("unknown --mode " + config.mode + "; there are: best, paper");
  }
  if (config.lag_ms != 0 && config.lag_ms != 100 && config.lag_ms != 200) {
    return UsageError("--lag-ms " + std::to_string(config.lag_ms) +
                      " is not possible; there are: 0, 100, 200");
  }
  return {};
}

}  // namespace footing::pose_service
