#pragma once

#include <optional>

#include "common/stream/character.h"
#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/mapping/inputs.h"

namespace footing::mapping {

/// Holds a change of gait back until it has lasted: while the person goes over from one motion to
/// another the features describe neither. A plain value.
class SettledGait {
 public:
  /// The settled gait, `seen` being what the features show at `time_s`; it settles once it,
  /// and no other, has been seen for `lasting_s`.
  stream::Gait Advance(double time_s, stream::Gait seen, double lasting_s);
  /// The features show nothing at `time_s`: the time until they do does not count.
  void Pause(double time_s);
  void Reset(stream::Gait gait);

  stream::Gait gait() const { return gait_; }
  /// Gait that is seen and has not settled yet; kUnspecified: none.
  stream::Gait next() const { return next_; }
  /// The part of its time that is over, 0 to 1.
  double share() const { return next_ == stream::Gait::kUnspecified ? 0 : share_; }

 private:
  stream::Gait gait_ = stream::Gait::kStep;
  stream::Gait next_ = stream::Gait::kUnspecified;
  double time_s_ = 0;
  double lasted_s_ = 0;
  double share_ = 0;
};

/// Mapping that the wrist, the arm and the leg interface share: two limbs that move alternately
/// walk or run, and together they jump (gait paper, section 7, figure 9).
struct SwingMapping {
  Scaling walk_mps_from_hz;
  Scaling run_mps_from_hz;
  Scaling jump_mps_from_hz;
  Scaling jump_m_from_mps2;
  double in_phase_below_rad = 0;
  double out_of_phase_above_rad = 0;
  /// Features must last this part of a cycle before they start a walk or a run from
  /// rest, before it starts a jump or changes one gait into another, and in any case this time: see
  /// SettledGait.
  double start_cycles = 0;
  double change_cycles = 0;
  double change_min_s = 0;
  double hold_s = 0;  ///< How long a gait goes on while features are not valid.

  bool IsOrdered() const;
};
void AddFields(SwingMapping& mapping, TableFields& fields);

/// The border between walking and running by frequency.
struct FrequencyBorder {
  double border_hz = 0;
  double hysteresis_hz = 0;  ///< On either side of the border.

  bool IsRun(double frequency_hz, stream::Gait now) const;
};
void AddFields(FrequencyBorder& border, TableFields& fields);

/// Mean over the limbs for which it is valid.
std::optional<double> MeanOf(const LimbPair& limbs, bool LimbFeatures::*valid,
                             double LimbFeatures::*value);

/// A plain value.
class SwingGait {
 public:
  explicit SwingGait(const SwingMapping& mapping) : mapping_(mapping) {}

  /// The command without its turn; `run`: alternate swings are to run, not to walk. Times must not
  /// decrease. While features of moving limbs are not valid the last command goes on, for at most
  /// hold_s.
  biped::GaitCommand Advance(double time_s, const LimbPair& limbs, bool run);
  /// Without limbs.
  biped::GaitCommand Rest();

  stream::Gait gait() const { return settled_.gait(); }
  /// Fills in what follows from the limbs.
  void Describe(const LimbPair& limbs, stream::InterfaceState& state) const;

 private:
  stream::Gait Seen(double phase_rad, bool run) const;
  void WaitForPhase(double time_s, bool run);
  void Know(const LimbPair& limbs);
  void FollowPace(double elapsed_s);
  void SetPace();

  SwingMapping mapping_;
  SettledGait settled_;
  biped::GaitCommand command_;
  double valid_time_s_ = 0;
  double time_s_ = 0;
  bool settled_run_ = false;  ///< `run` when the gait was last seen as it is.
  double known_hz_ = 0;       ///< The last frequency since the limbs began to move; 0: none.
  double known_mps2_ = 0;     ///< The last amplitude, in the same way.
  double pace_hz_ = 0;        ///< Frequency that the speed follows; 0: none yet.
  double slower_s_ = 0;       ///< For how long the limbs have been slower than that, ...
  double slower_hz_ = 0;      ///< ... and the highest frequency meanwhile.
  double other_s_ = 0;        ///< For how long it has been different without a phase.
};

/// The table of wrist_mapping.json.
struct WristMapping {
  SwingMapping swing;
  FrequencyBorder border;
  TurnMapping turn;
};

inline constexpr const char* kWristMappingFile = "wrist_mapping.json";
/// Every key, nothing unknown, all in range. `origin` names the file.
Result<WristMapping> ParseWristMapping(const std::string& text, const std::string& origin);

/// The wrist interface of the gait paper, section 7: two controllers swung from the wrists.
///
/// | motion                        | command                                                   |
/// |-------------------------------|-----------------------------------------------------------|
/// | a hand rests or is missing    | stepping in place                                         |
/// | in phase                      | jump; height by amplitude, speed by frequency             |
/// | out of phase, below 2 Hz      | walk, speed by frequency                                  |
/// | out of phase, above 2 Hz      | run, speed by frequency                                   |
/// | inclined beyond the dead band | besides, 5 degrees a step towards the lower side          |
///
/// Left side higher (positive roll) leans to the right, so it turns right, which is negative.
/// A plain value.
class WristInterface {
 public:
  explicit WristInterface(const WristMapping& mapping)
      : mapping_(mapping), gait_(mapping.swing), turn_(mapping.turn) {}

  /// The command for new inputs at `time_s`; times must not decrease.
  biped::GaitCommand Advance(double time_s, const Inputs& inputs);
  /// Forgets what the limbs showed before.
  void StartAgain() { gait_.Rest(); }
  const stream::InterfaceState& state() const { return state_; }

 private:
  WristMapping mapping_;
  SwingGait gait_;
  Turn turn_;
  stream::InterfaceState state_;
};

}  // namespace footing::mapping
