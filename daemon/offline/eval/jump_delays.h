#pragma once

#include <cstdint>
#include <optional>

namespace footing::eval {

/// Mean and spread of a time.
struct Delay {
  std::uint64_t count = 0;
  double sum_s = 0, sum_s2 = 0;

  void Add(double time_s);
  void Pool(const Delay& other);
  double mean_s() const { return count > 0 ? sum_s / static_cast<double>(count) : 0; }
  double sd_s() const;
};

/// Where the time of a jump goes: from the begin of the user's gesture to the command, which is the
/// interface's part, and from the command until the character leaves the ground, which is the
/// gait's. It is the spread of both, not their mean, that a user cannot learn.
class JumpDelays {
 public:
  /// One moment, every few milliseconds: whether the user means, the interface commands and the
  /// character does a jump. A gesture without a command within `delay_s` of its end does not count,
  /// nor does a command that ends without a jump.
  void Add(double time_s, bool meant, bool commanded, bool jumps, double delay_s);
  /// The character fell: what was under way does not count.
  void Restart();
  void Pool(const JumpDelays& other);

  const Delay& to_command() const { return to_command_; }
  const Delay& to_take_off() const { return to_take_off_; }  ///< From the command.

 private:
  bool meant_ = false, commanded_ = false;  ///< Of the last moment.
  double meant_s_ = 0;                      ///< When a jump was last meant.
  std::optional<double> begun_s_;           ///< Of a gesture without a command yet.
  std::optional<double> commanded_s_;       ///< Of its command, while the character does not jump.
  Delay to_command_, to_take_off_;
};

}  // namespace footing::eval
