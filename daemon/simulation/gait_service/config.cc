#include "daemon/simulation/gait_service/config.h"

#include "common/stream/leg_turn.h"

namespace footing::gait_service {

void Config::Bind(config::Binder& binder) {
  binder.Text("interface", interface,
              "User interface of the gait engine: " + stream::UserInterfaceNames());
  binder.Text("turn_by", turn_by,
              "Body part that steers with the interface leg: head, feet or trunk");
  binder.Flag("camera_roll", camera_roll, "Roll the picture with the head, with the interface leg");
  binder.Flag("boards_may_be_left", boards_may_be_left,
              "Let both feet leave the boards in a jump, with the interface boards; the person may "
              "fall beside a board");
  binder.Text("mapping_table", mapping_table,
              "Mapping table of the interface, JSON file, such as one of footing-study ranges "
              "(empty: the built-in one)");
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
  if (stream::UserInterfaceNamed(config.interface) == stream::UserInterface::kUnspecified) {
    return UsageError("unknown --interface " + config.interface +
                      "; there are: " + stream::UserInterfaceNames());
  }
  if (stream::LegTurnSourceNamed(config.turn_by) == stream::TurnSource::kUnspecified) {
    return UsageError("unknown turn_by " + config.turn_by + "; there are: head, feet, trunk");
  }
  return {};
}

stream::TurnSource LegTurnSource(int number) {
  for (const auto source : stream::kLegTurnSources) {
    if (number == static_cast<int>(source)) return source;
  }
  return stream::TurnSource::kUnspecified;
}

mapping::InterfaceOptions OptionsOf(const Config& config) {
  return {.interface = stream::UserInterfaceNamed(config.interface),
          .leg = {.turn_by = stream::LegTurnSourceNamed(config.turn_by),
                  .camera_roll = config.camera_roll},
          .boards_may_be_left = config.boards_may_be_left};
}

}  // namespace footing::gait_service
