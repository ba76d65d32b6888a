#include "daemon/simulation/serving/config.h"

namespace footing::serving {

void Config::Bind(config::Binder& binder) {
  binder.Text("engine", engine,
              "Engine: gait (a walking biped) or pose (a body reconstructed over two boards)");
  binder.Text("interface", interface, "User interface of the gait engine: wrist");
  binder.Text("sensor", sensor, "Address of footingd");
  binder.TextList("listen", listen, "Addresses for clients, unix:PATH or tcp:HOST:PORT");
  binder.Text("rig", rig, "Rig that commands the character (empty: the first with hand devices)");
  binder.Text("track", track, "Track: a built-in name, or a JSON file");
  binder.Text("data_folder", data_folder,
              "Folder with biped.json, wrist_mapping.json and the tracks");
  binder.Number("frame_rate_hz", frame_rate_hz, 10, 200, "Rate of character frames, Hz");
  binder.Number("features_timeout_s", features_timeout_s, 0.1, 5,
                "Time without new features after which the character steps in place, s");
  binder.Number("fall_shown_s", fall_shown_s, 0, 10,
                "Time from a fall until the character is put back on its feet, s");
  binder.Text("subject", subject,
              "Subject file of the pose engine: code, height_m, mass_kg, foot_length_m");
  binder.Text("mode", mode, "Reconstruction mode of the pose engine: best or paper");
  binder.Integer("lag_ms", lag_ms, 0, 200,
                 "Output delay of the pose engine, ms: 0, 100 or 200; longer is more accurate");
  binder.Number("put_back_distance_m", put_back_distance_m, 0, 20,
                "Distance by which a fallen character is put back along the track, m");
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

}  // namespace footing::serving
