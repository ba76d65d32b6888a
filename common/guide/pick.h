#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/board/geometry.h"
#include "common/guide/recent.h"

namespace footing::guide {

/// Which of several devices the person means. Never a guess: when two could be meant it says so.
struct Pick {
  enum class Kind { kNone, kOne, kAmbiguous };
  Kind kind = Kind::kNone;
  std::uint32_t device = 0;  ///< Of kOne.
  double lead = 0;           ///< How clearly: its signal over the next one's, at most 99.
  std::string note;          ///< What was seen, for a person.
};

struct BoardLoad {
  std::uint32_t device = 0;
  Load load;
};

struct DeviceMotion {
  std::uint32_t device = 0;
  Motion motion;
};

inline constexpr double kStoodOnN = 100;               ///< 10 kg: somebody stands on it.
inline constexpr double kFreeN = board::kContactOffN;  ///< Nobody does.
inline constexpr double kShakenMps2 = 4;     ///< A deliberate shake, four times a slow gesture.
inline constexpr double kClearlyMore = 2.5;  ///< Ratio of the shaken device to every other.

/// The one board that is stood on while every other is free.
Pick WhichBoard(const std::vector<BoardLoad>& boards);
/// The one hand device that is shaken, clearly more than every other.
Pick WhichShaken(const std::vector<DeviceMotion>& devices);

}  // namespace footing::guide
