#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "clients/stream/stand_in.h"
#include "common/result/result.h"

namespace footing::stream_client {

/// What the common flags say.
struct Common {
  std::string to;  ///< Empty: footingd's default device socket.
  std::uint64_t seed = 1;
  std::string link = "good";
  double rate_scale = 1;
  double seconds = 0;  ///< 0: the script again and again, a recording once.
};

/// What is in the Wiimotes' ports.
struct Ports {
  bool motion_plus = false;
  bool nunchuk = false;
};

/// Stand-ins and how long their motion lasts (0: without end).
struct Plan {
  std::vector<StandIn> devices;
  double duration_s = 0;
};

/// A made user; `script` a carried name or a path. `interface` "wrist": two Wiimotes that are
/// swung. "joystick": one Wiimote whose Nunchuk's stick walks, runs and turns, and whose button A
/// jumps (gait paper, section 7); it stands in for the right hand. A MotionPlus tells how the
/// inclination turns.
Result<Plan> PlanUser(const std::string& script, const std::string& interface, const Common& common,
                      const Ports& ports = {});

/// One or two Wiimotes that feel recorded accelerations: CSV `ax,ay,az`, m/s² in the sensor frame.
Result<Plan> PlanAccelerations(const std::string& left, const std::string& right, double rate_hz,
                               const Common& common);

/// One or two boards that feel recorded corners: CSV `time_s,tl_kg,tr_kg,bl_kg,br_kg`.
Result<Plan> PlanCorners(const std::string& left, const std::string& right, const Common& common);

}  // namespace footing::stream_client
