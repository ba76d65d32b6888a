#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "common/body/body.h"
#include "common/virtual/motion/motion.h"
#include "daemon/offline/learning/mlp.h"
#include "daemon/simulation/momentum/horizontal_network.h"

/// The horizontal COM from the loads of two boards (pose paper, section 4.2).
namespace footing::learning {

/// One frame, momentum::kNetworkRateHz a second.
struct LoadFrame {
  momentum::NetworkLoads load{};
  Eigen::Vector2d c_W_m{0, 0};  ///< COM, x forward and y left, from the origin of the loads.
};

/// Where the sum of all cells acts; nothing under 10 % of the weight, where noise decides.
std::optional<Eigen::Vector2d> Cop(const LoadFrame& frame);

using Networks = momentum::HorizontalLoop::Networks;

/// A recording without a gap.
using LoadClip = std::vector<LoadFrame>;

/// The runs of at least three seconds in which the COM stays within 40 cm of the origin: what can
/// be done on two boards.
std::vector<LoadClip> PartsInPlace(const LoadClip& clip);

/// Columns of the network's inputs that are its own outputs in use: c(t-2), c(t-1), c(t) of the
/// axis, and c(t) of the other.
std::vector<std::vector<Eigen::Index>> FeedbackColumns();

/// X = {F(t-1), F(t), c(t-2), c(t-1), c(t), other c(t)} -> Y = {c(t+1)} of `axis` (0 x, 1 y), for
/// every t of every clip that has them all.
Examples HorizontalExamples(std::span<const LoadClip> clips, int axis);

/// The same examples as the networks meet them when they go on from their own outputs: c(t-2),
/// c(t-1), c(t) and the other axis's c(t) are theirs, c(t+1) is true. A clip is restarted, from
/// the truth, every `restart_s`.
Examples RolledOutExamples(const Networks& networks, std::span<const LoadClip> clips, int axis,
                           double restart_s);

/// Root mean square error of each axis in metres when the networks go on from their own outputs,
/// from the third frame on.
Eigen::Vector2d ClosedLoopError(const Networks& networks, const LoadClip& clip);

/// The same of the COP, held where there is none: what a network that knows nothing else would say.
Eigen::Vector2d CopError(const LoadClip& clip);

/// A made recording: a body that leans and bends its knees as an inverted pendulum of 1 m over two
/// boards, all sums of sines with random phases, white noise on the cells.
struct SwaySettings {
  double seconds = 84;
  double rate_hz = 60;
  double noise_sd = 0.0013;  ///< Noise of a cell, in parts of the weight: 0.1 kg of 75 kg.
};
LoadClip MakeSway(const SwaySettings& settings, std::uint64_t seed);

/// Errors and limits of the boards in BoardLoads.
struct BoardLoadSettings {
  double noise_kg = 0.1;  ///< Noise of a cell.
  bool limited = true;    ///< Boards have an edge: virtual_sensors::LoadBoard.
  bool mirrored = false;  ///< The mirror image at the plane y = 0.
};

/// Loads that two boards under the feet would measure during a motion (common/virtual/devices), at
/// momentum::kNetworkRateHz. Each board's middle is where its foot mostly is. The origin is half
/// way between the points of the soles where the COP is at rest, where the feet mostly are; as in
/// use, when it comes from a T-pose. `motion` is aligned (time_alignment.h); `body` is of its
/// skeleton.
LoadClip BoardLoads(const motion::Motion& motion, const body::Body& body,
                    const BoardLoadSettings& settings, std::uint64_t seed);

}  // namespace footing::learning
