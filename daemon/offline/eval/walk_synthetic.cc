#include <memory>
#include <vector>

#include "common/base/units.h"
#include "common/virtual/devices/hand_motion.h"
#include "daemon/offline/eval/walk.h"

namespace footing::eval {

MountingWalk SyntheticWalk() {
  using wrists::Segment;
  constexpr double kStillS = 2.5;
  constexpr double kStepHz = 0.9;
  const auto degrees = DegreesToRadians;
  // Three steps are a cycle and a half of the arms.
  const std::vector<Segment> script = {
      {kStillS, kStepHz, kPi, 0, 0, 0},
      {1.5 / kStepHz, kStepHz, kPi, 7, 0, 0},
      {1.5, kStepHz, kPi, 0, 0, 0},
      {5, 0.9, kPi, 6, 0, 0},
      {4, 1.2, kPi, 9, degrees(5), degrees(-10)},
      {3.5, 1.6, 2.6, 13, degrees(-8), degrees(15)},
  };
  // The left arm begins backwards: its swing falls from half a turn on.
  const double start_rad = kPi - 2 * kPi * kStepHz * kStillS;
  auto motion = std::make_shared<wrists::HandMotion>(script, wrists::WristShape(), 0.3, start_rad);
  MountingWalk walk;
  walk.what = "two wrists of common/virtual/wrists";
  walk.roles[0] = stream::DeviceRole::kLeftHand;
  walk.roles[1] = stream::DeviceRole::kRightHand;
  walk.still_from_s = 0.2;
  walk.still_to_s = kStillS;
  walk.steps_to_s = kStillS + script[1].duration_s + 0.5;
  walk.walk_from_s = kStillS + script[1].duration_s + script[2].duration_s;
  walk.end_s = motion->DurationSeconds();
  walk.force_M_mps2 = [motion](int side, double t_s) {
    const wrists::Hands hands = motion->At(t_s);
    return side == 0 ? hands.left_mps2 : hands.right_mps2;
  };
  walk.truth = [script](double t_s) -> std::optional<WalkTruth> {
    double begin_s = 0;
    for (std::size_t i = 0; i < script.size(); ++i) {
      const Segment& segment = script[i];
      const double settled_s = begin_s + 0.5 + 3 / segment.frequency_hz;
      if (i >= 3 && t_s >= settled_s && t_s < begin_s + segment.duration_s) {
        return WalkTruth{segment.frequency_hz,
                         segment.phase_rad,
                         {segment.amplitude_mps2, segment.amplitude_mps2},
                         {segment.roll_rad, segment.roll_rad},
                         {segment.pitch_rad, segment.pitch_rad}};
      }
      begin_s += segment.duration_s;
    }
    return std::nullopt;
  };
  return walk;
}

}  // namespace footing::eval
