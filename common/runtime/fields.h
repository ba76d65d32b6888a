#pragma once

#include <cstdint>
#include <string>

namespace footing::log {

/// What a line is about, as fields of the journal: FOOTING_DEVICE, FOOTING_SESSION and
/// FOOTING_CHANNEL. Empty or 0: not about one.
struct Fields {
  std::string device;  ///< Its serial.
  std::uint64_t session = 0;
  std::string channel;
};

enum class Level { kInfo, kWarning, kError };

void Write(Level level, const std::string& line, const Fields& fields);

}  // namespace footing::log
