#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/runtime/follower.h"
#include "common/base/result.h"

namespace footing::clock {

/// Gives simulated time to threads of several processes: one works at a time, and once none has
/// anything to do the time goes on to the earliest instant for which one waits. In which order they
/// work follows from the order in which they came, so equal inputs give equal bits.
class Timekeeper {
 public:
  /// Listens on a Unix socket. `wall_ns` is the UNIX time at which simulated time begins.
  static Result<Timekeeper> Listen(const std::string& path, std::int64_t wall_ns);
  Timekeeper(Timekeeper&& other) noexcept;
  Timekeeper& operator=(Timekeeper&&) = delete;
  ~Timekeeper();

  std::int64_t now_ns() const { return now_ns_; }
  std::size_t followers() const { return seats_.size(); }

  /// Waits, on the host's clock, until another process follows; false when it does not come within
  /// `within_s`, or as soon as `gone` says that it will not.
  bool AwaitFollower(double within_s, const std::function<bool()>& gone);

  /// Gives one turn. False when a follower does not end it within a minute of the host's time, or
  /// when there is nobody who waits for an instant.
  bool GiveTurn();

 private:
  struct Seat {
    int descriptor = -1;
    std::int64_t due_ns = 0;
    bool listens = false;
    bool called = false;  ///< Another has acted since its last turn.
  };

  Timekeeper(int listening, std::int64_t wall_ns) : listening_(listening), wall_ns_(wall_ns) {}
  bool Accept();
  void Leave(std::size_t index);
  bool IsDue(const Seat& seat) const;
  std::int64_t AloneUntil(std::size_t index) const;
  std::size_t Next();

  int listening_;
  std::int64_t wall_ns_;
  std::int64_t now_ns_ = kStartNs;
  std::vector<Seat> seats_;

  /// Not 0: there is a time before the first instant, such as that of a sample.
  static constexpr std::int64_t kStartNs = 1'000'000'000'000;
};

}  // namespace footing::clock
