#include "daemon/simulation/service/config.h"

namespace footing::simulation {

void Config::Bind(config::Binder& binder) {
  binder.Text("engine", engine,
              "gait: the biped of the gait paper; pose: the body over two boards");
  binder.Text("interface", interface, "wrist: two controllers swung with the wrists");
  binder.Text("sensor", sensor, "Address of footingd");
  binder.TextList("listen", listen, "Addresses for viewers and loggers");
  binder.Text("rig", rig, "Rig whose motion commands; empty takes the first with hands");
  binder.Text("track", track, "Name of a carried track, or a path to a JSON file");
  binder.Text("data_folder", data_folder, "Folder of biped.json, wrist_mapping.json and tracks");
  binder.Number("frame_rate_hz", frame_rate_hz, 10, 200, "Character frames a second");
  binder.Number("features_timeout_s", features_timeout_s, 0.1, 5,
                "Without new features for so long the character steps in place");
  binder.Number("fall_shown_s", fall_shown_s, 0, 10, "From a fall to the put-back");
  binder.Text("subject", subject,
              "Subject file of the pose engine: code, height_m, mass_kg, foot_length_m");
  binder.Text("mode", mode, "Of the pose engine: best, or paper");
  binder.Integer("lag_ms", lag_ms, 0, 200, "Of the pose engine: 0, 100 or 200; later is better");
  binder.Number("put_back_distance_m", put_back_distance_m, 0, 20, "Back along the track");
}

Result<void> CheckBuilt(const Config& config) {
  if (config.engine != "gait" && config.engine != "pose") {
    return UsageError("--engine " + config.engine + " is not built; there are: gait, pose");
  }
  if (config.mode != "best" && config.mode != "paper") {
    return UsageError("--mode " + config.mode + " is not built; there are: best, paper");
  }
  if (config.lag_ms != 0 && config.lag_ms != 100 && config.lag_ms != 200) {
    return UsageError("--lag-ms " + std::to_string(config.lag_ms) +
                      " is not built; there are: 0, 100, 200");
  }
  if (config.interface != "wrist") {
    return UsageError("--interface " + config.interface + " is not built; there is: wrist");
  }
  return {};
}

}  // namespace footing::simulation
