#include "daemon/sensor/service/log_line.h"

#include "common/runtime/fields.h"

namespace footing::sensor {

void Log(const LogLine& line) {
  const log::Level level = line.warning ? log::Level::kWarning : log::Level::kInfo;
  log::Write(level, line.text, {line.device, 0, ""});
}

void LogOverload(const transport::OverloadLine& line) {
  log::Write(log::Level::kWarning, line.text, {"", line.session, line.channel});
}

}  // namespace footing::sensor
