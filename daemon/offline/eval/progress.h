#pragma once

#include <cstdint>
#include <ostream>
#include <string>

namespace footing::eval {

/// A line now and then while a command computes: "monkey: 120 of 600 s simulated". The first one
/// after 2 s, then one every 5 s; none for what ends sooner.
class Progress {
 public:
  /// `unit` follows the numbers: "trials", "s simulated".
  Progress(std::string command, std::string unit, double total, std::int64_t now_ns)
      : command_(std::move(command)),
        unit_(std::move(unit)),
        total_(total),
        next_ns_(now_ns + kFirstNs) {}

  /// Whole units only.
  void Done(double done, std::int64_t now_ns, std::ostream& out);

 private:
  static constexpr std::int64_t kFirstNs = 2'000'000'000, kEveryNs = 5'000'000'000;

  std::string command_, unit_;
  double total_;
  std::int64_t next_ns_;
};

}  // namespace footing::eval
