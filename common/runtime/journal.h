#pragma once

#include <string>

#include "common/runtime/log.h"

namespace footing::log {

/// Whether standard error goes to the journal of systemd, and that takes entries: JOURNAL_STREAM
/// names it (systemd.exec(5)). A pipe or a file put in its place does not.
bool StderrIsJournal();

/// One entry with its own priority (syslog(3)) and fields; false when the journal does not take it.
bool SendToJournal(int priority, const std::string& program, const std::string& line,
                   const Fields& fields);

}  // namespace footing::log
