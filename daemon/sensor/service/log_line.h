#pragma once

#include <string>

#include "common/net/server.h"

namespace footing::sensor {

/// A line for the log, the serial of the device that it is about, if any, and how much it matters.
struct LogLine {
  std::string text;
  std::string device = {};
  bool warning = false;
};

void Log(const LogLine& line);
void LogOverload(const transport::OverloadLine& line);

}  // namespace footing::sensor
