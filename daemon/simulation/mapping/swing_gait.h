#pragma once

#include <optional>

#include "daemon/simulation/biped/command.h"
#include "daemon/simulation/mapping/inputs.h"
#include "daemon/simulation/mapping/mapping_table.h"
#include "daemon/simulation/mapping/settled_gait.h"

/// What the wrist, the arm and the leg interface share: two limbs that move alternately walk or
/// run, and together they jump (gait paper, section 7, figure 9).
namespace footing::mapping {

struct SwingMapping {
  Scaling walk_mps_from_hz;
  Scaling run_mps_from_hz;
  Scaling jump_mps_from_hz;
  Scaling jump_m_from_mps2;
  double in_phase_below_rad = 0;
  double out_of_phase_above_rad = 0;
  /// What the features show must last this part of a cycle before it starts a walk or a run from
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
  void SetPace();

  SwingMapping mapping_;
  SettledGait settled_;
  biped::GaitCommand command_;
  double valid_time_s_ = 0;
  double time_s_ = 0;
  bool settled_run_ = false;  ///< `run` when the gait was last seen as it is.
  double known_hz_ = 0;       ///< The last frequency since the limbs began to move; 0: none.
  double known_mps2_ = 0;     ///< The last amplitude, in the same way.
  double other_s_ = 0;        ///< For how long it has been different without a phase.
};

}  // namespace footing::mapping
