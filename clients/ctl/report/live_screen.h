#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/stream/device.h"
#include "common/stream/sensor.h"
#include "common/stream/server_stats.h"

namespace footing::ctl::display {

/// What watch shows: the newest status and samples of every device. A plain value.
struct Live {
  struct Newest {
    std::optional<stream::MotionSample> motion;
    std::optional<stream::NunchukSample> nunchuk;
    std::optional<stream::GamepadSample> gamepad;
    std::optional<stream::BoardSample> board;
    std::uint64_t samples = 0;  ///< Since the watch began; of a gamepad where it has no motion.
  };
  std::vector<stream::DeviceStatus> devices;
  std::map<std::uint32_t, Newest> newest;     ///< By device number.
  std::string link;                           ///< How the connection stands.
  bool lost = false;                          ///< It does not stand: what is below is old.
  std::optional<stream::ServerStats> server;  ///< How it fares.
  std::string notice;                         ///< What slows the server; empty: nothing.

  void Take(const stream::MotionSample& sample);
  void Take(const stream::NunchukSample& sample);
  void Take(const stream::GamepadSample& sample);
  void Take(const stream::BoardSample& sample);
};

/// One screen: a table of the devices and below it what each measures, boards as bars in kg.
std::string LiveScreen(const Live& live);
/// One line, for a log.
std::string LiveLine(const Live& live);
/// {seconds, devices: [...]}, each with its newest sample as "motion", "nunchuk", "gamepad" or
/// "board".
nlohmann::ordered_json LiveToJson(const Live& live, double seconds);

}  // namespace footing::ctl::display
