#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/recording/records.h"

namespace footing::playback {

/// Sessions kept of one server: every tick is compared with each. Later ones are left out.
inline constexpr std::size_t kMostSessions = 10'000;

/// A connection of the recorder: what was made before it came later. Nanoseconds of both clocks.
struct RecordedWelcome {
  std::int64_t server_ns = 0;
  std::int64_t recorder_ns = 0;
};

/// What a recording says of one server.
struct RecordedServer {
  std::string name;
  std::int64_t offset_ns = 0;   ///< Its clock minus the recorder's.
  bool clock_measured = false;  ///< `offset_ns` is of "clock".
  std::vector<RecordedWelcome> welcomes;
  std::map<std::string, std::uint16_t> channels;  ///< By name, to the file's channel id.
};

/// Takes the metadata "clock": how the clocks stood at the recording's end.
void TakeClock(const mcap::TextMap& values, RecordedServer& server);

/// Takes the metadata "session" of a new connection. Until a clock is taken, the greeting of
/// another host gives the offset, late by the time it was under way. Gives UNIX time less the
/// recorder's clock; nothing when it does not say.
std::optional<std::int64_t> TakeSession(const mcap::TextMap& values, RecordedServer& server);

/// A tick made at `host_ns` and recorded at `recorded_ns` came as it was made.
bool IsLive(const RecordedServer& server, std::int64_t host_ns, std::int64_t recorded_ns);

}  // namespace footing::playback
