#pragma once

#include <optional>

#include "daemon/simulation/mapping/inputs.h"
#include "daemon/simulation/mapping/wrist.h"

namespace footing::mapping {

/// How the controllers lie in both hands, rotated about the forearms, while the arms are not
/// twisted. The same rotation of both hands looks like a twist, so it is learned from the person:
/// from arms that hang still before the first stride, since elbows are never quite straight; else
/// from the first strides, which are straight on by definition. From then on it follows slowly
/// while the arms are near it. A plain value.
class NeutralGrip {
 public:
  /// Mean rotation of both hands, left side up, of arms that hang still. Times must not decrease.
  void Hang(double time_s, double rotation_rad);
  /// The same of arms in motion, and the frequency of their swings.
  void Stride(double time_s, double rotation_rad, double frequency_hz);
  /// The arms rest and their rotation is not known: strides that were too few do not count.
  void Rest();
  /// Nothing is known of the hands.
  void Forget() { *this = NeutralGrip(); }
  /// The hands may hold the controllers otherwise now: what the present rest has shown counts, else
  /// what comes.
  void Renew();

  bool known() const { return known_; }
  /// The twist in a rotation, in the same direction; none while the neutral is not known.
  std::optional<double> TwistOf(double rotation_rad) const;

 private:
  void LearnFromRest();

  /// Mean of readings from a time on.
  struct Block {
    double from_s = 0, sum_rad = 0;
    int count = 0;
  };

  bool known_ = false;
  double neutral_rad_ = 0;
  double seen_s_ = 0;      ///< Length of what the neutral is the mean of.
  double time_s_ = 0;      ///< Time of the newest reading.
  bool striding_ = false;  ///< There is a reading of the present strides,
  bool strode_ = false;    ///< or of earlier ones: later rests do not count.
  bool hanging_ = false;
  Block block_;                        ///< The newest part of the present rest;
  std::optional<double> earlier_rad_;  ///< the mean of the one before,
  std::optional<double>
      rest_rad_;  ///< and of the one before that, from before a motion could begin.
};

/// The table of arm_mapping.json.
struct ArmMapping {
  SwingMapping swing;
  /// Elevation of the forearms above which straight arms become bent ones, and below which bent
  /// arms become straight ones.
  double bent_above_rad = 0;
  double straight_arm_below_rad = 0;
  TurnMapping turn;
};

inline constexpr const char* kArmMappingFile = "arm_mapping.json";
/// Every key, nothing unknown, all in range. `origin` names the file.
Result<ArmMapping> ParseArmMapping(const std::string& text, const std::string& origin);

/// Elevation of a forearm over the horizontal: -pi/2 hanging, 0 bent to the front. Not known: none.
///
/// It does not depend on a rotation of the controller about the forearm. Without a mounting the
/// controller's front points along the forearm to the fingers: the elevation is its pitch. With
/// one, down in M is along the forearm to the fingers, and the angle between that and gravity
/// follows from both inclinations; a forearm above the horizontal counts as one as far below it.
std::optional<double> ForearmElevation(const LimbFeatures& hand);

/// Rotation of a controller about the forearm, left side up. `by_swing`: from the direction of its
/// swing, which straight arms show; else from the direction of gravity, however high the forearm
/// is, unless it hangs straight down. Not known: none.
std::optional<double> ForearmRotation(const LimbFeatures& hand, bool by_swing);

/// The arm interface of the gait paper, section 7: two controllers in the hands of swinging arms.
///
/// | motion                        | command                                                   |
/// |-------------------------------|-----------------------------------------------------------|
/// | an arm rests or is missing    | stepping in place                                         |
/// | in phase                      | jump; height by amplitude, speed by frequency             |
/// | out of phase, straight        | walk, speed by frequency                                  |
/// | out of phase, bent            | run, speed by frequency                                   |
/// | straight arms twisted         | besides, 5 degrees a step to the side of the twist        |
/// | bent arms inclined sideways   | besides, 5 degrees a step towards the lower side          |
///
/// A hanging forearm that is twisted keeps its gravity, so the twist of straight arms is taken from
/// the direction of their swing against the controllers, which bent arms leave to the inclination.
/// Both need both hands: grips that are mirror images of each other cancel. An equal rotation of
/// both is learned (NeutralGrip), unless both have a mounting. A plain value.
class ArmInterface {
 public:
  explicit ArmInterface(const ArmMapping& mapping)
      : mapping_(mapping), gait_(mapping.swing), turn_(mapping.turn) {}

  /// The command for new inputs at `time_s`; times must not decrease.
  biped::GaitCommand Advance(double time_s, const Inputs& inputs);
  /// Forgets what the limbs showed before.
  void StartAgain() { gait_.Rest(); }
  /// How the controllers lie in the hands is learned again.
  void RenewGrip() { grip_.Renew(); }
  const stream::InterfaceState& state() const { return state_; }

 private:
  std::optional<double> TurnRight(double time_s, const LimbPair& hands);
  void NoteMissing(double time_s, const LimbPair& hands);

  ArmMapping mapping_;
  SwingGait gait_;
  Turn turn_;
  NeutralGrip grip_;
  double present_s_ = 0;  ///< When both hands were there last.
  bool bent_ = false;
  stream::InterfaceState state_;
};

}  // namespace footing::mapping
