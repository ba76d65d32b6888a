#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/base/result.h"

namespace footing::clock {

/// Messages of a follower and its timekeeper over a Unix socket, in the host's byte order:
/// both are of one build on one machine. A follower begins with a TurnEnd that is due at once.
struct TurnEnd {
  std::int64_t now_ns = 0;   ///< At its end.
  std::int64_t due_ns = 0;   ///< When it wants its next turn; kNever.
  std::uint8_t acted = 0;    ///< It did something that another thread or process may wait for.
  std::uint8_t listens = 0;  ///< It wants a turn, too, after each one in which another has acted.
  std::uint8_t padding[6]{};
};
/// Until another acts or an instant has come at which another is due, the follower may go on with
/// the time by itself.
struct Turn {
  std::int64_t now_ns = 0;
  std::int64_t wall_ns = 0;
  std::int64_t alone_until_ns = 0;  ///< Before this instant nobody else is due.
};

constexpr std::int64_t kNever = INT64_MAX;

/// One thread that follows a timekeeper: it works in turns with all the others, one at a time, and
/// its time stands still while it works. When the timekeeper is gone the process ends with exit
/// code 1, since its time does not go on.
class Follower {
 public:
  /// To the timekeeper's socket; may be used by another thread than the one that makes it.
  static Result<std::unique_ptr<Follower>> Connect(const std::string& path);
  ~Follower();
  Follower(const Follower&) = delete;
  Follower& operator=(const Follower&) = delete;

  const std::string& path() const { return path_; }
  std::int64_t now_ns() const { return turn_.now_ns; }
  std::int64_t wall_ns() const { return turn_.wall_ns; }

  /// The first turn, before anything else.
  void WaitForTurn();
  /// This turn does something that another thread or process may notice.
  void Act() { acted_ = true; }
  /// Ends the turn; the next one is at `due_ns`, not before.
  void Sleep(std::int64_t due_ns) { EndTurn(due_ns, false); }
  /// Ends the turn; the next one is at `due_ns`, or when another has acted before.
  void Listen(std::int64_t due_ns) { EndTurn(due_ns, true); }

 private:
  Follower(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}
  void EndTurn(std::int64_t due_ns, bool listens);

  const std::string path_;
  const int descriptor_;
  Turn turn_;
  bool acted_ = false;
};

/// Reads or writes a whole message; false when the other side is gone.
template <typename Message>
bool ReadMessage(int descriptor, Message& message);
template <typename Message>
bool WriteMessage(int descriptor, const Message& message);

// The clocks of the host. Pure code takes time as an argument instead.
//
// Where the process follows a timekeeper its threads have simulated time: it stands still while
// they work, and goes on to the next instant at which one of them has something to do. Then a
// study of hours runs in minutes, and equal inputs give equal bits.

/// CLOCK_MONOTONIC in nanoseconds: the clock of every stamp in the protocol.
std::int64_t MonotonicNs();

/// UNIX time in nanoseconds: only to date recordings and to anchor MonotonicNs() in a Welcome.
std::int64_t WallNs();

/// CPU time of the calling thread in nanoseconds; never simulated.
std::int64_t ThreadCpuNs();

/// Waits until MonotonicNs() reaches `deadline_ns`.
void SleepUntil(std::int64_t deadline_ns);

/// Environment variable: the socket of the timekeeper that the programs started with it follow.
constexpr char kTimekeeperVariable[] = "FOOTING_TIMEKEEPER";

/// Lets the calling thread follow the timekeeper of the environment, if there is one, from its
/// first turn on, for which it waits. Of a program call it in main, before anything asks for the
/// time.
Result<void> FollowTimekeeper();

/// A follower for a thread that is about to be started, which hands it to Follow(); null in a
/// thread that follows none. Made before, so that time stands still until the new thread has had a
/// turn.
std::unique_ptr<Follower> NewFollower();
/// Nothing happens without a follower. Waits for the calling thread's first turn.
void Follow(std::unique_ptr<Follower> follower);

/// The calling thread does something that another thread or process may be waiting for, such as a
/// write to a socket: who follows the same timekeeper and listens has a turn at this instant.
void Act();

/// Follower of the calling thread; null: it has the host's time.
Follower* OwnFollower();

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
