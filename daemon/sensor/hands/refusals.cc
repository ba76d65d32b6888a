#include "daemon/sensor/hands/refusals.h"

namespace footing::hands {

std::optional<std::string> Refusals::Add(std::int64_t now_ns, const std::string& what,
                                         const std::string& why) {
  ++total_;
  if (reported_ns_ && now_ns - *reported_ns_ < kQuietNs) return std::nullopt;
  const std::uint64_t since = total_ - reported_;
  reported_ns_ = now_ns;
  reported_ = total_;
  std::string line = "device socket: " + what + " is refused: " + why;
  if (since > 1) line += " (" + std::to_string(since) + " refused since the last such line)";
  return line;
}

}  // namespace footing::hands
