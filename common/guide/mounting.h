#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/guide/recent.h"

namespace footing::guide {

/// It is fastened to a limb, so its directions have to be found.
bool NeedsMounting(stream::DeviceRole role);
/// Its directions can be found: those of what needs it, and of a remote on a wrist. One that is
/// held in the hand, buttons up, lies as it should.
bool CanBeMounted(stream::DeviceRole role);
/// How a device is mounted, drawn for a terminal: shin outside, head band, wrist. Empty for boards.
std::string Picture(stream::DeviceRole role);
/// The same in a sentence.
std::string Wearing(stream::DeviceRole role);

inline constexpr double kStillForS = 2;

/// What the mounted devices show of "two seconds still, then three steps": where each stretch lies.
/// The steps begin half a second before a movement shows, so that its very first way is among them.
/// A plain value that is asked again and again.
class StillThenSteps {
 public:
  enum class Phase { kStill, kSteps, kDone };

  /// `moving` is the largest shake of all mounted devices during the last half second; not known
  /// (no samples) counts as moving.
  void Advance(std::int64_t now_ns, double moving_mps2);

  Phase phase() const { return phase_; }
  /// Stillness so far, s; at most kStillForS counts.
  double still_s(std::int64_t now_ns) const;
  std::int64_t still_from_ns() const { return still_from_ns_; }
  std::int64_t still_to_ns() const { return still_to_ns_; }
  std::int64_t steps_from_ns() const { return still_to_ns_; }
  std::int64_t steps_to_ns() const { return steps_to_ns_; }

 private:
  Phase phase_ = Phase::kStill;
  std::int64_t still_from_ns_ = 0;  // 0: not still.
  std::int64_t still_to_ns_ = 0;
  std::int64_t moved_first_ns_ = 0;
  std::int64_t moved_last_ns_ = 0;
  std::int64_t steps_to_ns_ = 0;
};

/// A solved mounting is good up to this residual.
inline constexpr double kMountingBarDeg = 15;

}  // namespace footing::guide
