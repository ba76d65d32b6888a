#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/stream/device.h"
#include "common/stream/gait.h"
#include "common/stream/trial.h"
#include "common/stream/user_interface.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/devices/noise.h"

namespace footing::users {

/// True specific force on one Wiimote on the body, in its frame S, m/s2.
struct FeltRemote {
  stream::DeviceRole role = stream::DeviceRole::kUnspecified;
  Eigen::Vector3d specific_force_S_mps2 = Eigen::Vector3d::Zero();
};

/// True inputs of all devices of an interface; those that it does not have stay as they are here.
struct Felt {
  std::array<FeltRemote, 3> remotes;
  int remote_count = 0;
  double stick_x = 0;  ///< -1 left to 1 right.
  double stick_y = 0;  ///< -1 back to 1 front.
  bool button_a = false;
  /// Under the left and the right foot, in W with the origin between the boards.
  std::array<virtual_sensors::FootForce, 2> feet;
};

// Synthetic users: what they see, what they want, and how their bodies do it. Frames: world W
// (x forward, y left, z up), sensor S of a Wiimote (x left, y front, z down). SI units.

/// Traits that make a user an individual.
struct Style {
  double reaction_s = 0.3;     ///< From the picture to a decision; 0.2 to 0.4.
  double favourite_mps = 2.6;  ///< Speed of running; 2.2 to 3.
  double amplitude = 1;        ///< Size of motions, as a share of ordinary ones; 0.85 to 1.2.
  double asymmetry = 0;        ///< Left larger, right smaller by this share; -0.1 to 0.1.
  double tempo = 1;            ///< Frequencies as a share of ordinary ones; 0.94 to 1.06.
  double tempo_drift = 0.03;   ///< Standard deviation of its slow change, as a share.
  double phase_error_rad = 0;  ///< By which alternate limbs are off half a cycle; -0.25 to 0.25.
  double timing_s = 0.1;       ///< Standard deviation of the moment of a jump; 0.05 to 0.15.
  double left_grip_rad = 0;    ///< Rotation of the remote about its front, left side up.
  double right_grip_rad = 0;   ///< The same of the right one.
  double mass_kg = 70;         ///< 50 to 95.
  double height_m = 1.72;      ///< 1.55 to 1.95.
};

/// How a user moves, where it is not as drawn.
struct StyleWish {
  std::optional<double> tempo, amplitude, asymmetry;
};

/// Evenly within the ranges above; the remotes as they should be held.
Style DrawStyle(std::uint64_t seed);
/// The same person with the remotes as people hold and wear them: each by its own up to
/// MostGrip(interface) off.
Style DrawStyle(std::uint64_t seed, stream::UserInterface interface);

/// How far a remote is rotated, rad. In the hands of swinging arms, where nobody looks at it, by 45
/// degrees (the gait paper names different grips as a difficulty of that interface). Wrists hold it
/// buttons up in sight, and shins wear it with a mounting: a few degrees. No stick and no board can
/// be rotated.
double MostGrip(stream::UserInterface interface);

/// A joint or a limb on its way to where it is wanted: critically damped, so that forces stay
/// finite. Arrives within a tenth after about 4 time constants.
struct Follower {
  double value = 0;
  double rate = 0;

  void Advance(double target, double time_constant_s, double step_s);
};

/// Left and right limb of a rhythmic motion: common tempo with the person's slow drift, a phase
/// between them, and an amplitude that grows from rest. A plain value.
class Rhythm {
 public:
  Rhythm(const Style& style, std::uint64_t seed) : style_(style), random_(seed) {}

  /// How the limbs are to move; frequency of one limb. `together`: in phase, else alternately.
  struct Aim {
    bool moves = false;
    bool together = false;
    double frequency_hz = 1;
    double amplitude = 1;  ///< Share of the motion's own.
  };
  void Advance(const Aim& aim, double step_s);

  /// Cycles since the start, of the left and of the right limb.
  double left_cycles() const { return cycles_; }
  double right_cycles() const { return cycles_ + phase_.value; }
  double left_amplitude() const { return amplitude_.value * (1 + style_.asymmetry); }
  double right_amplitude() const { return amplitude_.value * (1 - style_.asymmetry); }
  /// 0 at rest to 1 in full motion.
  double activity() const { return activity_.value; }
  double frequency_hz() const { return frequency_.value; }

 private:
  Style style_;
  noise::Random random_;
  double cycles_ = 0;
  double drift_ = 0;
  Follower frequency_{1, 0};
  Follower phase_{0.5, 0};  ///< Right minus left, cycles.
  Follower amplitude_;
  Follower activity_;
};

/// Character and trial as a person in front of the screen sees them, as published.
struct Observation {
  double time_s = 0;
  Eigen::Vector2d p_W_m = Eigen::Vector2d::Zero();
  double com_m = 0;  ///< Height of the COM.
  double heading_rad = 0;
  double speed_mps = 0;
  std::uint64_t steps = 0;
  std::uint64_t falls = 0;
  stream::Gait gait = stream::Gait::kStep;
  stream::TrialProgress trial;
};

/// Intention of the user for the character.
struct Intention {
  stream::Gait gait = stream::Gait::kStep;
  double speed_mps = 0;
  double height_m = 0;  ///< Height of a jump.
  double turn_rad = 0;  ///< A step, left positive.
  /// How fast to move, for its gait: 0 as slowly as is comfortable, 1 as fast. From the speed
  /// wanted and, since the person sees the result, the speed seen.
  double effort = 0;
  double size = 1;  ///< Size of the motion, as a share of the user's own.
};

/// A thumb on the stick of a Nunchuk, and the other on button A of the Wiimote. A plain value.
class StickBody {
 public:
  StickBody(const Style& style, std::uint64_t seed);

  void Advance(const Intention& wanted, double step_s);
  void Feel(Felt& felt) const;
  stream::Gait gesture() const { return gesture_; }
  double limb_hz() const { return 0; }

 private:
  Style style_;
  noise::Random random_;
  double bias_rad_;  ///< Straight on as this thumb does it.
  Follower right_, front_;
  double tremor_ = 0;
  bool wanted_jump_ = false;
  double pressed_s_ = 0;  ///< The button is down for this much longer.
  stream::Gait gesture_ = stream::Gait::kStep;
};

/// Intention of a user for a while.
struct Act {
  Intention wanted;
  double duration_s = 0;
};

/// The motions for which `footing-study ranges` prompts, as a user of this interface performs them:
/// slow and fast, low and high, to the left and to the right. `turn_by` is of the leg interface.
/// Empty for a joystick, on which style has no effect.
std::vector<Act> RangeActs(stream::UserInterface interface,
                           stream::TurnSource turn_by = stream::TurnSource::kHead);
/// Intention at this time, s; the first act follows the last one. `acts` must not be empty.
const Intention& WantedAt(const std::vector<Act>& acts, double time_s);

/// How a user is to hold the remotes, in place of what the style draws.
struct GripWish {
  double rotation_rad = 0;
  /// Both about the same way, to the left or to the right; else as mirror images of each other.
  bool same = false;
};

/// From options: degrees, and `way` "mirrored" or "same". Only users of wrist and arm hold remotes
/// that they swing: a usage error else.
Result<GripWish> ParseGrip(double rotation_deg, const std::string& way,
                           stream::UserInterface interface);

/// The style of a user of this interface, with the grips and the motions given, or as drawn. Which
/// hand, and which way, is a matter of the seed.
Style StyleOf(std::uint64_t seed, stream::UserInterface interface,
              const std::optional<GripWish>& grip, const StyleWish& wish = {});

}  // namespace footing::users
