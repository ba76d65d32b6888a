#include "daemon/sensor/mounting/refusals.h"

#include <utility>

namespace footing::hands {

std::optional<std::string> Refusals::Say(std::int64_t now_ns, const std::string& what, Kind& kind) {
  if (kind.unsaid == 0 || (kind.said_ns && now_ns - *kind.said_ns < kQuietNs)) return std::nullopt;
  const bool first = !kind.said_ns;
  const std::uint64_t refused = std::exchange(kind.unsaid, 0);
  kind.said_ns = now_ns;
  std::string line = "device socket: " + what + " is refused: " + kind.why;
  if (!first) line += " (" + std::to_string(refused) + " refused since the last such line)";
  return line;
}

std::optional<std::string> Refusals::Add(std::int64_t now_ns, const std::string& what,
                                         const std::string& why) {
  ++total_;
  Kind& kind = kinds_[what];
  ++kind.unsaid;
  kind.why = why;
  return Say(now_ns, what, kind);
}

std::vector<std::string> Refusals::Due(std::int64_t now_ns) {
  std::vector<std::string> lines;
  for (auto& [what, kind] : kinds_) {
    if (auto line = Say(now_ns, what, kind)) lines.push_back(std::move(*line));
  }
  return lines;
}

}  // namespace footing::hands
