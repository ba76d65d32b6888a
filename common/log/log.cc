#include "common/log/log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <cerrno>
#include <memory>

namespace footing::log {
namespace {

/// spdlog's own logger writes to standard output, where --json has its object alone.
void Write(spdlog::level::level_enum level, const std::string& line) {
  if (spdlog::default_logger()->name().empty()) Start(program_invocation_short_name, false);
  spdlog::log(level, "{}", line);
}

}  // namespace

void Start(const std::string& program, bool quiet) {
  auto logger =
      std::make_shared<spdlog::logger>(program, std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_pattern("%Y-%m-%dT%H:%M:%S.%e %n %l: %v");
  logger->set_level(quiet ? spdlog::level::warn : spdlog::level::info);
  logger->flush_on(spdlog::level::info);
  spdlog::set_default_logger(logger);
}

void Info(const std::string& line) { Write(spdlog::level::info, line); }
void Warning(const std::string& line) { Write(spdlog::level::warn, line); }
void Error(const std::string& line) { Write(spdlog::level::err, line); }

}  // namespace footing::log
