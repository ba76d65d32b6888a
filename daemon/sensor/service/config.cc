#include "daemon/sensor/service/config.h"

#include "daemon/sensor/service/binding.h"

namespace footing::sensor {

void Config::Bind(config::Binder& binder) {
  binder.TextList("listen", listen, "Addresses for clients");
  binder.TextList("sources", sources, "hid, or stream:ADDRESS for device stand-ins");
  binder.TextMap("roles", roles,
                 "Serial to rig/role, e.g. {\"00:1f:32:aa:bb:cc\": \"main/left_hand\"}",
                 [](const std::string& text) {
                   const auto binding = ParseBinding(text);
                   return binding ? std::string() : binding.error().message;
                 });
  binder.Text("default_rig", default_rig, "Rig of devices that nobody assigned");
  binder.Number("tick_rate_hz", tick_rate_hz, 10, 200, "Ticks a second");
  binder.Number("stale_after_s", stale_after_s, 0.1, 10, "Without data for so long: stale");
  binder.Number("board_sensor_distance_x_m", plate.sensor_distance_x_m, 0.1, 1,
                "Between a board's left and right sensors");
  binder.Number("board_sensor_distance_y_m", plate.sensor_distance_y_m, 0.1, 1,
                "Between a board's front and rear sensors");
  binder.Number("board_contact_on_n", plate.contact_on_n, 1, 500, "Over it there is contact");
  binder.Number("board_contact_off_n", plate.contact_off_n, 1, 500,
                "Under it there is none, and the COP is undefined");
  binder.Number("board_uniform_rate_hz", board_uniform.rate_hz, 10, 1000,
                "Of the channel boards_uniform");
  binder.Number("board_uniform_window_s", board_uniform.window_s, 0.01, 0.5,
                "Each of its samples is the mean over so long");
  binder.Number("local_gravity_mps2", local_gravity_mps2, 9.76, 9.84,
                "Where the boards stand; divided out of their forces");
  binder.Text(
      "state_directory", state_directory,
      "Where the set-up is kept; empty: $STATE_DIRECTORY, else $XDG_STATE_HOME/footing, else "
      "~/.local/state/footing; none: nowhere");
  binder.Flag("motion_plus", motion_plus, "Look for MotionPlus and use it");
  binder.Flag("camera", camera, "Switch the infrared cameras of Wiimotes on");
  binder.Number("status_interval_s", status_interval_s, 0, 3600,
                "Ask devices for their status so often; 0 never");
}

Result<std::optional<transport::Address>> ParseSource(const std::string& text) {
  static const std::string kPrefix = "stream:";
  if (text == "hid") return std::optional<transport::Address>();
  if (!text.starts_with(kPrefix)) {
    return UsageError("source \"" + text + "\": there are hid and stream:ADDRESS");
  }
  const auto address = transport::ParseAddress(text.substr(kPrefix.size()));
  if (!address) return address.error();
  return std::optional(*address);
}

Result<void> Check(const Config& config) {
  for (const std::string& text : config.listen) {
    if (const auto address = transport::ParseAddress(text); !address) return address.error();
  }
  for (const std::string& text : config.sources) {
    if (const auto source = ParseSource(text); !source) return source.error();
  }
  if (config.plate.contact_on_n < config.plate.contact_off_n) {
    return UsageError("config: board_contact_on_n must not be below board_contact_off_n");
  }
  return {};
}

}  // namespace footing::sensor
