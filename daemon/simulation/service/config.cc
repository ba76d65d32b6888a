#include "daemon/simulation/service/config.h"

namespace footing::simulation {

void Config::Bind(config::Binder& binder) {
  binder.Text("engine", engine, "gait: the biped of the gait paper");
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
  binder.Number("put_back_distance_m", put_back_distance_m, 0, 20, "Back along the track");
}

Result<void> CheckBuilt(const Config& config) {
  if (config.engine != "gait") {
    return UsageError("--engine " + config.engine + " is not built; there is: gait");
  }
  if (config.interface != "wrist") {
    return UsageError("--interface " + config.interface + " is not built; there is: wrist");
  }
  return {};
}

}  // namespace footing::simulation
