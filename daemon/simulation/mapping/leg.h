#pragma once

#include "daemon/simulation/mapping/swing_gait.h"
#include "daemon/simulation/mapping/turn.h"

namespace footing::mapping {

/// The table of leg_mapping.json.
struct LegMapping {
  SwingMapping swing;
  FrequencyBorder border;
  TurnMapping turn;  ///< By the inclination of head or trunk.
  /// By the feet: difference of the amplitudes over their sum.
  double feet_turn_above = 0;
  double feet_straight_below = 0;
  /// The picture follows the head: what a study chooses with the table that it sends. Optional.
  bool camera_roll = false;
};

inline constexpr const char* kLegMappingFile = "leg_mapping.json";
/// Every key, nothing unknown, all in range. `origin` names the file.
Result<LegMapping> ParseLegMapping(const std::string& text, const std::string& origin);

struct LegOptions {
  stream::TurnSource turn_by = stream::TurnSource::kHead;  ///< kHead, kFeet or kTrunk.
  /// The picture follows the head; the table may choose that, too.
  bool camera_roll = false;
};

/// The leg interface of the gait paper, section 7: controllers on both shins of a person who steps
/// in place, and one on the head or the trunk.
///
/// | motion                          | command                                                 |
/// |---------------------------------|---------------------------------------------------------|
/// | standing still, a leg missing   | stepping in place                                       |
/// | both legs together              | jump; height by amplitude, speed by frequency           |
/// | stepping, a leg below 2 Hz      | walk, speed by frequency                                |
/// | stepping, a leg above 2 Hz      | run, speed by frequency                                 |
/// | head or trunk inclined sideways | besides, 5 degrees a step towards the lower side        |
/// | or one foot lifted higher       | besides, 5 degrees a step away from it: it is the outer |
///
/// While the feet turn, the legs walk or run whatever their phase.
/// A plain value.
class LegInterface {
 public:
  LegInterface(const LegMapping& mapping, const LegOptions& options);

  /// The command for new inputs at `time_s`; times must not decrease.
  biped::GaitCommand Advance(double time_s, const Inputs& inputs);
  /// What the limbs showed before does not count.
  void StartAgain() { gait_.Rest(); }
  const stream::InterfaceState& state() const { return state_; }

 private:
  LegMapping mapping_;
  LegOptions options_;
  SwingGait gait_;
  Turn turn_;
  stream::InterfaceState state_;
};

}  // namespace footing::mapping
