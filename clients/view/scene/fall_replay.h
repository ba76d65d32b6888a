#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "clients/view/scene/update.h"

namespace footing::scene {

/// Keeps what led to the last fall, to be seen again in slow motion.
///
/// A fall is a character's count of falls gone up. Its clip begins 5 s before it and ends when the
/// characters are put back (one moved more than 0.5 m between two frames), 1.5 s after it at the
/// latest.
class FallReplay {
 public:
  static constexpr double kBeforeS = 5;
  static constexpr double kAfterS = 1.5;
  static constexpr double kPace = 0.25;  ///< Seconds of the clip a second of the viewer.

  /// Every frame, in the order of coming. A step back in simulation time means a restarted server:
  /// what was kept is dropped.
  void Push(const WorldFrame& frame);

  /// True once a fall has been seen to its end.
  bool ready() const { return !clip_.empty() && !filling_; }
  /// Counts the clips that became ready.
  std::uint64_t clips() const { return clips_; }

  /// From the clip's start, at `now_ns` of the viewer's clock. Does nothing before ready().
  void Start(std::int64_t now_ns);
  void Stop() { started_ns_.reset(); }

  /// What to show while a replay runs; nothing before and after it.
  std::optional<WorldFrame> At(std::int64_t now_ns) const;
  /// Time of the clip at `now_ns` less that of the fall, s: negative before it.
  double FromFallS(std::int64_t now_ns) const { return ClipTimeS(now_ns) - fall_s_; }

 private:
  double ClipTimeS(std::int64_t now_ns) const;
  void TakeClip(double fall_s);

  std::deque<WorldFrame> recent_;
  std::deque<WorldFrame> clip_;
  double fall_s_ = 0;
  bool filling_ = false;
  std::uint64_t clips_ = 0;
  std::optional<std::int64_t> started_ns_;
};

}  // namespace footing::scene
