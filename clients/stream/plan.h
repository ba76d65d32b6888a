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

/// Stand-ins and how long their motion lasts (0: without end).
struct Plan {
  std::vector<StandIn> devices;
  double duration_s = 0;
};

/// Two Wiimotes swung by a made user. `interface` is "wrist"; `script` a carried name or a path.
Result<Plan> PlanUser(const std::string& script, const std::string& interface,
                      const Common& common);

/// One or two Wiimotes that feel recorded accelerations: CSV `ax,ay,az`, m/s² in the sensor frame.
Result<Plan> PlanAccelerations(const std::string& left, const std::string& right, double rate_hz,
                               const Common& common);

/// One or two boards that feel recorded corners: CSV `time_s,tl_kg,tr_kg,bl_kg,br_kg`.
Result<Plan> PlanCorners(const std::string& left, const std::string& right, const Common& common);

}  // namespace footing::stream_client
