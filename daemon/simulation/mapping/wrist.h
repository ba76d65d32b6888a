#pragma once

#include "daemon/simulation/mapping/swing_gait.h"
#include "daemon/simulation/mapping/turn.h"

namespace footing::mapping {

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
  /// What the limbs showed before does not count.
  void StartAgain() { gait_.Rest(); }
  const stream::InterfaceState& state() const { return state_; }

 private:
  WristMapping mapping_;
  SwingGait gait_;
  Turn turn_;
  stream::InterfaceState state_;
};

}  // namespace footing::mapping
