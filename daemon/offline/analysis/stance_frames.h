#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace footing::eval {

/// The frames of one foot while it stands: from 0.1 s after its landing to 0.1 s before it leaves.
/// A foot that lands or leaves does move over the ground, with some load on it already or still.
class StanceFrames {
 public:
  static constexpr double kEdgeS = 0.1;
  using Speeds = std::array<double, 2>;  ///< Estimated and true.

  /// The next frame. Returns those of kEdgeS ago when the foot stood then.
  std::optional<Speeds> Advance(bool contact, const Speeds& speeds, double step_s) {
    const bool stood = contact_ && since_s_ > kEdgeS - 1e-9;  // In the frame before, too.
    since_s_ = contact && contact_ ? since_s_ + step_s : 0;
    contact_ = contact;
    if (!contact) waiting_ = 0;
    if (!contact || !stood) return std::nullopt;
    const auto edge = static_cast<std::size_t>(std::lround(kEdgeS / step_s));
    if (edge == 0 || edge > kMost) return std::nullopt;
    Speeds& oldest = speeds_[next_++ % edge];
    const Speeds before = oldest;
    oldest = speeds;
    if (waiting_ < edge) {
      ++waiting_;
      return std::nullopt;
    }
    return before;
  }

 private:
  static constexpr std::size_t kMost = 32;

  bool contact_ = false;
  double since_s_ = 0;  // The landing.
  std::array<Speeds, kMost> speeds_{};
  std::size_t waiting_ = 0, next_ = 0;
};

}  // namespace footing::eval
