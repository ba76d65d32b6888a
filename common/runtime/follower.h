#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "common/base/result.h"

namespace footing::clock {

/// What a follower and its timekeeper send each other over a Unix socket, in the host's byte order:
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

}  // namespace footing::clock
