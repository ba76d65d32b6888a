#pragma once

#include <string>
#include <variant>

#include "daemon/simulation/mapping/arm.h"
#include "daemon/simulation/mapping/boards.h"
#include "daemon/simulation/mapping/inputs.h"
#include "daemon/simulation/mapping/wrist.h"

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

/// Options of the leg interface.
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
  /// Forgets what the limbs showed before.
  void StartAgain() { gait_.Rest(); }
  const stream::InterfaceState& state() const { return state_; }

 private:
  LegMapping mapping_;
  LegOptions options_;
  SwingGait gait_;
  Turn turn_;
  stream::InterfaceState state_;
};

/// Which interface, and what of it a study chooses.
struct InterfaceOptions {
  stream::UserInterface interface = stream::UserInterface::kWrist;
  LegOptions leg = {};
  bool boards_may_be_left = false;
};

/// The file of an interface's table under daemon/simulation/data.
const char* MappingFileOf(stream::UserInterface interface);

/// Bits (stream::RoleBit) of the roles that the interface needs and that are not among `present`.
std::uint32_t MissingRoles(const InterfaceOptions& options, std::uint32_t present);

/// One of the interfaces. A plain value.
class AnyInterface {
 public:
  /// `table` is the text of MappingFileOf(options.interface), or of what `from` names. Fails with
  /// one line that names it and the key.
  static Result<AnyInterface> Create(const InterfaceOptions& options, const std::string& table,
                                     const std::string& from = "");

  /// The command for new inputs at `time_s`; times must not decrease. A jump keeps the speed of the
  /// run-up until the character jumps: braked before, it would be shorter than a stride.
  biped::GaitCommand Advance(double time_s, const Inputs& inputs);
  /// Without inputs: as if every device were missing.
  biped::GaitCommand Rest(double time_s) { return Advance(time_s, {}); }
  /// For a character that is put somewhere else: a single jump that was commanded before, and that
  /// it has not made, is not made any more; wrists, arms and legs have to show a gait again before
  /// it goes on.
  void StartAgain();
  /// A new trial: how the person holds the controllers is learned again where it is learned.
  void RenewGrip();
  /// The person's movement as the interface takes it, as of the last Advance.
  const stream::InterfaceState& state() const;

 private:
  using Variant =
      std::variant<WristInterface, ArmInterface, LegInterface, JoystickInterface, BoardsInterface>;
  explicit AnyInterface(const Variant& interface) : interface_(interface) {}
  Variant interface_;
  double run_mps_ = 0;  ///< Commanded last of a run.
};

}  // namespace footing::mapping
