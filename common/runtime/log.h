#pragma once

#include <cstdint>
#include <string>

/// Log lines to standard error. Only at the edge that decides, never on the simulation thread and
/// never in pure code.
namespace footing::log {

/// Sets the program's name in every line. `quiet` keeps only warnings and errors. A program that
/// never calls it logs under the name of its file.
void Start(const std::string& program, bool quiet);

/// Logs a line at one of three levels.
void Info(const std::string& line);
void Warning(const std::string& line);
void Error(const std::string& line);

/// Subject of a line, as fields of the journal: FOOTING_DEVICE, FOOTING_SESSION and
/// FOOTING_CHANNEL. Empty or 0: not about one.
struct Fields {
  std::string device;  ///< Its serial.
  std::uint64_t session = 0;
  std::string channel;
};

enum class Level { kInfo, kWarning, kError };

/// Logs a line with the fields that name its subject.
void Write(Level level, const std::string& line, const Fields& fields);

}  // namespace footing::log
