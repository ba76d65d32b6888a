#include "daemon/simulation/footing_sim/config.h"

#include "common/net/metrics_endpoint.h"
#include "common/net/address_or_default.h"

namespace footing::footing_sim {

void Config::Bind(config::Binder& binder) {
  binder.Text("engine", engine,
              "Engine: gait (a walking biped) or pose (a body reconstructed over two boards)");
  serving.Bind(binder);
  gait.Bind(binder);
  pose.Bind(binder);
}

Result<void> Check(const Config& config) {
  if (config.engine != "gait" && config.engine != "pose") {
    return UsageError("unknown --engine " + config.engine + "; there are: gait, pose");
  }
  const auto sensor = transport::AddressOrDefault(config.serving.sensor, "sensor");
  if (!sensor) return UsageError("--sensor: " + sensor.error().message);
  if (!config.serving.metrics.empty()) {
    const auto metrics = monitoring::MetricsEndpoint::Check(config.serving.metrics);
    if (!metrics) return metrics;
  }
  if (const auto checked = gait_service::Check(config.gait); !checked) return checked;
  return pose_service::Check(config.pose);
}

Result<void> CheckApply(const Config& config, const std::vector<std::string>& settings) {
  const bool pose = config.engine == "pose";
  config::Binder others;  // Has the keys of the engine that does not run.
  gait_service::Config gait;
  pose_service::Config body;
  if (pose) {
    gait.Bind(others);
  } else {
    body.Bind(others);
  }
  for (const std::string& setting : settings) {
    const std::string key = setting.substr(0, setting.find('='));
    if (!others.Has(key)) continue;
    return UsageError(key + " does not apply to --engine " + config.engine +
                      ": it is a setting of --engine " + (pose ? "gait" : "pose") +
                      "; leave it out, or choose that engine");
  }
  return {};
}

}  // namespace footing::footing_sim
