#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace footing::hands {

/// Counts what is refused, each kind of message by itself, and says when a line for a person is
/// due: at once, then at most one a kind in ten seconds, which says how many there were. A plain
/// value; time is an argument.
class Refusals {
 public:
  static constexpr std::int64_t kQuietNs = 10'000'000'000;

  /// `what` is "a hand frame", `why` what is wrong with it.
  std::optional<std::string> Add(std::int64_t now_ns, const std::string& what,
                                 const std::string& why);
  /// The lines that are due for what was refused in quiet since.
  std::vector<std::string> Due(std::int64_t now_ns);

  std::uint64_t total() const { return total_; }

 private:
  struct Kind {
    std::uint64_t unsaid = 0;
    std::string why;  ///< Of the newest.
    std::optional<std::int64_t> said_ns;
  };

  static std::optional<std::string> Say(std::int64_t now_ns, const std::string& what, Kind& kind);

  std::uint64_t total_ = 0;
  std::map<std::string, Kind> kinds_;
};

}  // namespace footing::hands
