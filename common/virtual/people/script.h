#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"

/// Synthetic motion: a short script of key poses becomes a motion that a person could make, with
/// feet that stay where they stand and a centre of pressure that stays where the script puts it.
namespace footing::choreography {

/// Channels that a script sets. All are 0 in the T-pose. Of each pair the left one comes first.
enum class Channel {
  kCrouch,     ///< m, hips below standing.
  kBow,        ///< rad, trunk to the front.
  kBend,       ///< rad, trunk to the left.
  kTwist,      ///< rad, trunk to the left about the vertical.
  kNod,        ///< rad, head to the front.
  kLook,       ///< rad, head to the left.
  kWeight,     ///< Where the pressure is: -1 right foot, 0 middle, 1 left foot.
  kAhead,      ///< -1 near the heels, 0 where a standing foot carries, 1 near the toes.
  kLeftRaise,  ///< rad, upper arm above level.
  kRightRaise,
  kLeftFront,  ///< rad, upper arm turned from the side to the front.
  kRightFront,
  kLeftRoll,  ///< rad, upper arm about itself: the bent forearm goes up.
  kRightRoll,
  kLeftElbow,  ///< rad, bent.
  kRightElbow,
  kLeftLift,  ///< m, ankle above standing.
  kRightLift,
  kLeftStep,  ///< m, foot ahead of where it stands in the T-pose.
  kRightStep,
  kLeftOut,  ///< m, foot outside of where it stands in the T-pose.
  kRightOut,
};
inline constexpr std::size_t kChannels = 22;

using Values = std::array<double, kChannels>;
inline double& At(Values& values, Channel channel) {
  return values[static_cast<std::size_t>(channel)];
}
inline double At(const Values& values, Channel channel) {
  return values[static_cast<std::size_t>(channel)];
}

/// All channels blend to `values` within `seconds`, without a jump of velocity or acceleration.
struct Key {
  double seconds = 1;
  Values values{};
};

/// Key poses in their order.
struct Script {
  std::vector<Key> keys;
  double sway_m = 0;  ///< Root mean square of the pressure's wandering, each way.

  double duration_s() const;
  /// All channels are 0 at the end, as at the beginning: it can be performed again at once.
  bool EndsInTPose() const;
};

/// A script from JSON: {"sway_mm": 2, "keys": [...]}. A key is {"seconds": 2, CHANNEL: VALUE, ...};
/// what it does not name stays; {"repeat": 3, "keys": [...]} stands for its keys three times. The
/// channels are crouch_m, bow_deg, bend_deg, twist_deg, nod_deg, look_deg, weight, ahead, and with
/// left_, right_ or both_ in front raise_deg, front_deg, roll_deg, elbow_deg, lift_m, step_m,
/// out_m.
///
/// Errors name `origin` and the key: an unknown name, a value out of its range, a foot that lifts
/// or steps while it carries weight, hips that would have to fall faster than a body does.
Result<Script> ParseScript(const std::string& text, const std::string& origin);

/// Names of the built-in scripts, and one of them; a usage error lists the names.
std::vector<std::string> BuiltInScriptNames();
Result<Script> BuiltInScript(const std::string& name);

/// The channels through time at equal steps: one entry a frame, from 0 to the script's end. A step
/// lifts its foot by itself.
std::vector<Values> Sample(const Script& script, double rate_hz);

/// How the pressure wanders while somebody stands: a sum of sines of 0.1 to 1.1 Hz with this root
/// mean square each way, 0 at time 0. The same for everybody.
Eigen::Vector2d Sway(double sway_m, double t_s);

}  // namespace footing::choreography
