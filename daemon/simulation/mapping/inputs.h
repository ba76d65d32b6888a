#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/stream/inputs.h"
#include "common/stream/sensor.h"
#include "common/stream/user_interface.h"

/// Inputs of the user interfaces: plain values of fixed size. Copying allocates nothing, so they
/// can pass to the simulation thread.
namespace footing::mapping {

/// The features of one controller (gait paper, section 6).
using LimbFeatures = stream::HandInput;

/// A left and a right limb.
struct LimbPair {
  LimbFeatures left;
  LimbFeatures right;
  bool phase_valid = false;
  double phase_rad = 0;  ///< Right minus left, in (-pi, pi].

  bool operator==(const LimbPair&) const = default;
};

using stream::StickInput;

using stream::BoardInput;

/// The bit of `role` when its controller is missing, or is worn without a mounting; else 0.
constexpr std::uint32_t Missing(const LimbFeatures& limb, stream::DeviceRole role) {
  return limb.present ? 0 : stream::RoleBit(role);
}
constexpr std::uint32_t Unmounted(const LimbFeatures& limb, stream::DeviceRole role) {
  return !limb.present || limb.mounted ? 0 : stream::RoleBit(role);
}

/// Readings of the devices that one person wears, holds and stands on at one instant.
struct Inputs {
  LimbPair hands;
  LimbPair legs;
  LimbFeatures head;
  LimbFeatures trunk;
  StickInput stick;
  BoardInput left_board;
  BoardInput right_board;
  bool simulated = false;  ///< A simulated device is among them.
  /// The gait that the character runs; the engine fills it in.
  stream::Gait running = stream::Gait::kStep;

  bool operator==(const Inputs&) const = default;
};

/// The features of a controller. Numbers that are not finite count as not valid. One from which
/// footingd has not heard for a while, so that it knows neither motion nor inclination, is not
/// present.
LimbFeatures ToLimb(const stream::DeviceFeatures& device, bool mounted);

/// Replaces hands, legs, head and trunk by those of the rig: devices by their roles, and the pairs
/// they form. What the rig lacks is not present. Bits of `mounted_roles` are by stream::RoleBit.
void TakeFeatures(const stream::RigFeatures& rig, std::uint32_t mounted_roles, Inputs& inputs);

// The files NAME_mapping.json: from a person's comfortable range to the character's stable one
// (gait paper, section 7).

/// Two ends of a linear, clamped scaling.
struct Scaling {
  double from_min = 0, from_max = 1;
  double to_min = 0, to_max = 1;

  double operator()(double from) const;
  /// Whether `from` has a length and `to` does not fall.
  bool Rises() const { return from_min < from_max && to_min <= to_max; }
};

/// Unit of a number in the file; it is stored in SI.
enum class Unit { kSi, kDegrees };

/// One number of a table.
struct TableField {
  const char* key;
  double* value;
  double min, max;
  Unit unit = Unit::kSi;
};
using TableFields = std::vector<TableField>;

/// One choice of a table, true or false; a table may be without it.
struct TableFlag {
  const char* key;
  bool* value;
};

/// Reads a table: the version 1, how the numbers were found, where measured ones come from, every
/// key of `fields`, nothing unknown but `flags`, all in range. `origin` names the file.
Result<void> ReadTable(const std::string& text, const std::string& origin,
                       const TableFields& fields, const std::vector<TableFlag>& flags = {});

/// The error for a table whose numbers contradict each other.
Error NotOrdered(const std::string& origin);

/// The four ends of a scaling, with the range that each may have.
struct ScalingKeys {
  const char *from_min, *from_max, *to_min, *to_max;
  double least_from, most_from, least_to, most_to;
};
void AddFields(const ScalingKeys& keys, Scaling& scaling, TableFields& fields);
/// Speeds of walking and running by a limb's frequency.
void AddSpeedFields(Scaling& walk_mps_from_hz, Scaling& run_mps_from_hz, TableFields& fields);

/// How an inclination turns the character: beyond the dead band by a constant angle a step (gait
/// paper, section 7). The borders are radians, or shares where something else than an angle turns.
struct TurnMapping {
  double turn_above = 0;
  double straight_below = 0;
  double turn_per_step_rad = 0;

  bool IsOrdered() const { return straight_below <= turn_above; }
};

/// Fields turn_above_deg, straight_below_deg and turn_per_step_deg; as_share: the borders are
/// turn_above and straight_below, from 0 to 1.
void AddFields(TurnMapping& mapping, bool as_share, TableFields& fields);

/// The dead band with its hysteresis. A plain value.
class Turn {
 public:
  /// How long a turn goes on while what commands it is not known, s.
  static constexpr double kHoldS = 0.5;

  explicit Turn(const TurnMapping& mapping) : mapping_(mapping) {}

  /// `right`: how far to the right, in the unit of the borders; none while it is not known. The
  /// turn a step, positive to the left.
  double Advance(double time_s, std::optional<double> right);
  /// Straight on.
  void Rest();

  bool valid() const { return valid_; }
  /// 1: turns to the right, -1: to the left, 0: straight on.
  int side() const { return side_; }
  /// The newest `right`, as a share of the border at which turning begins.
  double share() const { return share_; }

 private:
  TurnMapping mapping_;
  int side_ = 0;
  double known_s_ = 0;
  bool valid_ = false;
  double share_ = 0;
};

}  // namespace footing::mapping
