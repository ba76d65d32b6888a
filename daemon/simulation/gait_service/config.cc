#include "daemon/simulation/gait_service/config.h"

namespace footing::gait_service {

void Config::Bind(config::Binder& binder) {
  binder.Text("interface", interface, "User interface of the gait engine: wrist");
  binder.Text("track", track, "Track of the gait engine: a built-in name, or a JSON file");
  binder.Number("frame_rate_hz", frame_rate_hz, 10, 200, "Rate of character frames, Hz");
  binder.Number("features_timeout_s", features_timeout_s, 0.1, 5,
                "Time without new features after which the character steps in place, s");
  binder.Number("fall_shown_s", fall_shown_s, 0, 10,
                "Time from a failure until the character is put back on its feet, s");
  binder.Number("put_back_distance_m", put_back_distance_m, 0, 20,
                "Distance by which a fallen character is put back along the track, m");
}

Result<void> Check(const Config& config) {
  if (config.interface != "wrist") {
    return UsageError("unknown --interface " + config.interface + "; there is: wrist");
  }
  return {};
}

}  // namespace footing::gait_service
