#include "common/runtime/journal.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <vector>

#define SD_JOURNAL_SUPPRESS_LOCATION  // It would be this file's in every entry.
#include <systemd/sd-journal.h>

namespace footing::log {

bool StderrIsJournal() {
  const char* const stream = std::getenv("JOURNAL_STREAM");
  struct stat own {};
  if (stream == nullptr || fstat(STDERR_FILENO, &own) != 0) return false;
  // Without it libsystemd drops entries and reports success.
  if (access("/run/systemd/journal/socket", W_OK) != 0) return false;
  return stream == std::to_string(own.st_dev) + ":" + std::to_string(own.st_ino);
}

bool SendToJournal(int priority, const std::string& program, const std::string& line,
                   const Fields& fields) {
  std::vector<std::string> entry = {"MESSAGE=" + line, "PRIORITY=" + std::to_string(priority),
                                    "SYSLOG_IDENTIFIER=" + program};
  if (!fields.device.empty()) entry.push_back("FOOTING_DEVICE=" + fields.device);
  if (fields.session != 0) entry.push_back("FOOTING_SESSION=" + std::to_string(fields.session));
  if (!fields.channel.empty()) entry.push_back("FOOTING_CHANNEL=" + fields.channel);
  std::vector<iovec> parts;
  for (std::string& field : entry) parts.push_back({field.data(), field.size()});
  return sd_journal_sendv(parts.data(), static_cast<int>(parts.size())) == 0;
}

}  // namespace footing::log
