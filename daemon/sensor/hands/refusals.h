#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace footing::hands {

/// Counts what is refused and says when a line for a person is due: at once, then at most one in
/// ten seconds, which says how many there were. A plain value; time is an argument.
class Refusals {
 public:
  static constexpr std::int64_t kQuietNs = 10'000'000'000;

  /// `what` is "a hand frame", `why` what is wrong with it.
  std::optional<std::string> Add(std::int64_t now_ns, const std::string& what,
                                 const std::string& why);

  std::uint64_t total() const { return total_; }

 private:
  std::uint64_t total_ = 0;
  std::uint64_t reported_ = 0;
  std::optional<std::int64_t> reported_ns_;
};

}  // namespace footing::hands
