#pragma once

#include <cstdint>
#include <optional>

namespace footing::eval {

/// Which of a user's gestures of a jump became a command, and which commanded jumps nobody meant.
/// The share of time that Agreement counts does not show them: a gesture may be shorter than the
/// delay that a command is allowed.
class JumpEvents {
 public:
  /// One moment, every few milliseconds. A gesture is recognised when a jump is commanded while it
  /// lasts or within `delay_s` of its end, and late when that is longer than `delay_s` after its
  /// begin. A command was meant when it begins at most that long after a moment of a gesture.
  void Add(double time_s, bool meant, bool commanded, double delay_s);
  /// The character fell: a gesture that had no command yet does not count, unless the delay was
  /// over.
  void Restart();
  void Pool(const JumpEvents& other);

  std::uint64_t meant() const { return meant_count_; }
  std::uint64_t recognised() const { return recognised_; }
  std::uint64_t late() const { return late_; }  ///< Of recognised().
  std::uint64_t commanded() const { return commanded_count_; }
  std::uint64_t not_meant() const { return not_meant_; }
  /// Shares of meant() and of commanded().
  double recall() const { return Share(recognised_, meant_count_, 1); }
  double false_share() const { return Share(not_meant_, commanded_count_, 0); }

 private:
  static double Share(std::uint64_t part, std::uint64_t all, double of_none) {
    return all > 0 ? static_cast<double>(part) / static_cast<double>(all) : of_none;
  }
  void Decide(bool recognised, bool late);

  bool meant_ = false, commanded_ = false;  ///< Of the last moment.
  std::optional<double> begun_s_;           ///< Of a gesture that is not decided yet.
  std::optional<double> meant_s_;           ///< When a jump was last meant.
  bool overdue_ = false;                    ///< The delay of that gesture is over.
  std::uint64_t meant_count_ = 0, recognised_ = 0, late_ = 0;
  std::uint64_t commanded_count_ = 0, not_meant_ = 0;
};

}  // namespace footing::eval
