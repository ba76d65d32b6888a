#include "clients/stream/live_runner.h"

#include <cmath>
#include <utility>

#include "common/base/units.h"
#include "common/virtual/devices/random.h"
#include "common/virtual/devices/accelerometer.h"
#include "common/wire/scalar.h"
#include "common/wire/wire.h"

namespace footing::stream_client {
namespace {

/// How fast the hands change from one swing to another.
constexpr double kSwingChangeS = 0.12;

wrists::HandMotion UnitSwing() {
  wrists::Segment segment;
  segment.frequency_hz = 1;
  segment.phase_rad = kPi;
  segment.amplitude_mps2 = 1;
  return {{segment}, wrists::WristShape(), 0};
}

}  // namespace

LiveRunner::LiveRunner(std::uint64_t seed) : runner_(seed), unit_(UnitSwing()) {}

void LiveRunner::See(const v1::Tick& tick) {
  if (tick.has_track()) runner_.SeeTrack(wire::FromProto(tick.track()));
  if (tick.characters().characters_size() == 0) return;
  const v1::Character& character = tick.characters().characters(0);
  runner_.See(time_s_, {wire::FromProto(character.com_m()).head<2>(),
                        wire::Finite(character.gait().heading_rad()),
                        wire::Finite(character.gait().speed_mps())});
}

wrists::Hands LiveRunner::At(double t_s) {
  const double step_s = t_s - time_s_;
  if (step_s > 0) {
    time_s_ = t_s;
    const RunnerSwing wanted = runner_.Want(t_s);
    const double share = 1 - std::exp(-step_s / kSwingChangeS);
    swing_.amplitude_mps2 += share * (wanted.amplitude_mps2 - swing_.amplitude_mps2);
    swing_.roll_rad += share * (wanted.roll_rad - swing_.roll_rad);
    swing_.frequency_hz += share * (wanted.frequency_hz - swing_.frequency_hz);
    cycles_ += swing_.frequency_hz * step_s;
  }
  const Eigen::Vector3d level = wrists::InclinedGravity(0, 0);
  const Eigen::Vector3d inclined = wrists::InclinedGravity(swing_.roll_rad, 0);
  const wrists::Hands unit = unit_.At(std::fmod(cycles_, 1.0));
  return {inclined + swing_.amplitude_mps2 * (unit.left_mps2 - level),
          inclined + swing_.amplitude_mps2 * (unit.right_mps2 - level)};
}

Result<RunnerPlan> PlanRunner(const Common& common) {
  const auto link = ParseLink(common.link);
  if (!link) return link.error();
  RunnerPlan planned;
  planned.runner = std::make_shared<LiveRunner>(common.seed);
  for (const bool left : {true, false}) {
    const std::uint64_t device = left ? 1 : 2;
    const auto motion = [runner = planned.runner, left,
                         random = noise::Random(DeviceSeed(common, device))](double t_s) mutable {
      const wrists::Hands hands = runner->At(t_s);
      virtual_devices::WiimoteSensors sensors;
      sensors.specific_force_S_mps2 = left ? hands.left_mps2 : hands.right_mps2;
      for (int axis = 0; axis < 3; ++axis) {
        sensors.specific_force_S_mps2[axis] += wrists::SensorModel().noise_mps2 * random.Normal();
      }
      return sensors;
    };
    const auto role = left ? stream::DeviceRole::kLeftHand : stream::DeviceRole::kRightHand;
    planned.plan.devices.push_back(MakeWiimote(common, *link, device, role, motion));
  }
  planned.plan.duration_s = common.seconds;
  return planned;
}

}  // namespace footing::stream_client
