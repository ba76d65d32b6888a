#include "common/runtime/log.h"

#include <cerrno>
#include <memory>
#include <utility>

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <syslog.h>

#include "common/runtime/journal.h"

namespace footing::log {
namespace {

/// The level of spdlog, and syslog's.
std::pair<spdlog::level::level_enum, int> Of(Level level) {
  switch (level) {
    case Level::kInfo:
      return {spdlog::level::info, LOG_INFO};
    case Level::kWarning:
      return {spdlog::level::warn, LOG_WARNING};
    case Level::kError:
      break;
  }
  return {spdlog::level::err, LOG_ERR};
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

/// spdlog's own logger writes to standard output, where --json has its object alone.
void Write(Level level, const std::string& line, const Fields& fields) {
  if (spdlog::default_logger()->name().empty()) Start(program_invocation_short_name, false);
  static const bool to_journal = StderrIsJournal();
  const auto [of_spdlog, priority] = Of(level);
  if (!spdlog::should_log(of_spdlog)) return;
  // The journal has its own time stamp and shows name and priority apart from the line.
  const std::string program = spdlog::default_logger()->name();
  if (to_journal && SendToJournal(priority, program, line, fields)) return;
  spdlog::log(of_spdlog, "{}", line);
}

void Info(const std::string& line) { Write(Level::kInfo, line, {}); }
void Warning(const std::string& line) { Write(Level::kWarning, line, {}); }
void Error(const std::string& line) { Write(Level::kError, line, {}); }

}  // namespace footing::log
