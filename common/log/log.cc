#include "common/log/log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <memory>

namespace footing::log {

void Start(const std::string& program, bool quiet) {
  auto logger =
      std::make_shared<spdlog::logger>(program, std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_pattern("%Y-%m-%dT%H:%M:%S.%e %n %l: %v");
  logger->set_level(quiet ? spdlog::level::warn : spdlog::level::info);
  logger->flush_on(spdlog::level::info);
  spdlog::set_default_logger(logger);
}

void Info(const std::string& line) { spdlog::info("{}", line); }
void Warning(const std::string& line) { spdlog::warn("{}", line); }
void Error(const std::string& line) { spdlog::error("{}", line); }

}  // namespace footing::log
