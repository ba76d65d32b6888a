#include "common/recording/recorded_server.h"

#include <algorithm>
#include <string_view>

#include "common/base/number.h"
#include "common/base/instant.h"

namespace footing::playback {
namespace {

std::string TextOf(const mcap::TextMap& values, const std::string& key) {
  const auto found = values.find(key);
  return found == values.end() ? "" : found->second;
}

/// A whole number within kMostInstantNs; nothing where there is none.
std::optional<std::int64_t> WholeOf(const mcap::TextMap& values, const std::string& key) {
  const std::string word = TextOf(values, key);
  const bool negative = !word.empty() && word[0] == '-';
  const auto count = text::ToCount(std::string_view(word).substr(negative ? 1 : 0));
  if (!count || *count > static_cast<std::size_t>(kMostInstantNs)) return std::nullopt;
  return (negative ? -1 : 1) * static_cast<std::int64_t>(*count);
}

/// On one host both read the same clock: an estimate could only add its own error.
bool OnThisHost(const mcap::TextMap& values) {
  return TextOf(values, "address").rfind("unix:", 0) == 0;
}

}  // namespace

void TakeClock(const mcap::TextMap& values, RecordedServer& server) {
  if (TextOf(values, "valid") != "true" || OnThisHost(values)) return;
  const std::optional<std::int64_t> offset_ns = WholeOf(values, "server_minus_recorder_ns");
  if (!offset_ns) return;
  server.offset_ns = *offset_ns;
  server.clock_measured = true;
}

std::optional<std::int64_t> TakeSession(const mcap::TextMap& values, RecordedServer& server) {
  const std::optional<std::int64_t> server_ns = WholeOf(values, "server_host_ns");
  const std::optional<std::int64_t> recorder_ns = WholeOf(values, "recorder_host_ns");
  if (!server_ns || !recorder_ns) return std::nullopt;
  if (server.welcomes.size() < kMostSessions) server.welcomes.push_back({*server_ns, *recorder_ns});
  const bool other_host = !TextOf(values, "address").empty() && !OnThisHost(values);
  const std::int64_t offset_ns = *server_ns - *recorder_ns;
  if (other_host && !server.clock_measured && IsInstant(offset_ns)) server.offset_ns = offset_ns;
  const std::int64_t wall_ns = WholeOf(values, "server_wall_time_ns").value_or(0);
  if (wall_ns == 0) return std::nullopt;
  return wall_ns - *recorder_ns;
}

bool IsLive(const RecordedServer& server, std::int64_t host_ns, std::int64_t recorded_ns) {
  return std::none_of(server.welcomes.begin(), server.welcomes.end(), [&](const auto& welcome) {
    return host_ns < welcome.server_ns && recorded_ns >= welcome.recorder_ns;
  });
}

}  // namespace footing::playback
