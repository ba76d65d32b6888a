#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "clients/study/plan/ranges.h"
#include "common/board/step_cadence.h"
#include "common/stream/sensor.h"

namespace footing::study::ranges {

/// Motion of a person on two boards at one instant, by the recognisers of the interface boards.
struct BoardMotion {
  bool stands = false;  ///< Somebody stands on the boards.
  bool steps = false;   ///< Steps in place for over a cycle, and this step is not late.
  double foot_hz = 0;   ///< While stepping, of one foot in the last two steps.
  bool leans_known = false;
  double lean_right = 0;  ///< Share of the load, -1 to 1; stepping the mean of two steps.
  bool rose = false;      ///< A heel rise's push is over.
  double rise_share = 0;  ///< Load above the weight in that push, as its share.
};

/// Follows a person on two boards. A plain value.
class BoardMeter {
 public:
  BoardMeter();

  /// Times must not decrease.
  BoardMotion Advance(double time_s, const board::Stance& stance);

 private:
  board::Weight weight_;
  board::StepCadence steps_;
  board::HeelRise rise_;
  bool begun_ = false;
  double time_s_ = 0;
  double stands_until_s_ = 0;  ///< When the feet began to take turns, or now.
  double rose_s_ = -1;         ///< When a rise was recognised whose push goes on; negative: none.
  double push_ = 0;            ///< Push of that rise so far, share of the weight.
};

/// Measures what a person does, from what footingd publishes. What is done in which order does not
/// matter: alternate, common and turning motion are distinguished as the interfaces do it. A plain
/// value.
class Meter {
 public:
  explicit Meter(const Played& played) : played_(played) {}

  /// Features of the person's rig at `time_s`; bits of `mounted_roles` are by stream::RoleBit.
  void Add(double time_s, const stream::RigFeatures& rig, std::uint32_t mounted_roles);
  /// The stick of a Nunchuk: x -1 left to 1 right, y -1 back to 1 front.
  void AddStick(double time_s, double x, double y, bool simulated);

  /// Two boards that both send.
  void AddStance(double time_s, const board::Stance& stance, bool simulated);

  /// Ranges measured: the 5th and the 95th percentile of each quantity. NoDevice, with their roles,
  /// where devices were missing; a failure, with the motion to repeat, where a motion was not seen
  /// for long enough.
  Result<Ranges> Measure() const;
  bool simulated() const { return simulated_; }

 private:
  struct Pool {
    std::vector<double> values;
    double seconds = 0;
  };
  struct Limbs;

  /// Motion of two limbs, and when it began.
  struct Motion {
    enum class Kind { kNone, kAlternate, kTogether } kind = Kind::kNone;
    double since_s = 0;
    double moved_s = 0;  ///< When both limbs last moved.
  };

  double Elapse(double time_s);
  /// Whether the motion has lasted for a whole cycle: the features of its first one are also those
  /// of what was before.
  bool Settled(Motion::Kind kind, double frequency_hz);
  void Put(const char* quantity, double value, double elapsed_s);
  void AddSwing(const Limbs& limbs, double elapsed_s);
  void AddTurn(const stream::RigFeatures& rig, const Limbs& limbs, double elapsed_s);
  double SecondsOf(const char* quantity) const;
  Result<void> CheckDevices() const;
  Result<void> Require(const char* quantity, double least_s, const std::string& motion) const;

  Played played_;
  std::map<std::string, Pool> pools_;
  Motion motion_;
  BoardMeter boards_;
  double time_s_ = -1;
  double seen_s_ = 0;     ///< Time with anything of the person's.
  double unequal_s_ = 0;  ///< Left and right at different frequencies.
  std::map<stream::DeviceRole, double> present_s_;
  bool simulated_ = false;
};

}  // namespace footing::study::ranges
