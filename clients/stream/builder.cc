#include "clients/stream/builder.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "common/base/units.h"
#include "common/virtual/devices/random.h"
#include "common/virtual/devices/accelerometer.h"
#include "common/virtual/devices/hand_motion.h"

namespace footing::stream_client {
namespace {

constexpr int kRepeats = 12;
constexpr double kLeastHeldS = 1.0, kMostHeldS = 1.8;
constexpr double kLeastRad = 15 * kPi / 180, kMostRad = 45 * kPi / 180;
constexpr double kGripChangeS = 0.25;
/// Button bits of the Wiimote.
constexpr std::uint16_t kButtonA = 0x0008, kButtonB = 0x0004;

/// Signs of roll and pitch, and the buttons.
std::vector<BuilderGrip> Kinds(bool pits) {
  std::vector<BuilderGrip> kinds{{0, 1}, {0, -1}, {1, 0}, {-1, 0}, {0, 1, true}, {0, -1, true}, {}};
  if (pits) kinds.push_back({0, 0, false, true});
  return kinds;
}

}  // namespace

BuilderScript::BuilderScript(std::uint64_t seed, bool pits) {
  noise::Random random(seed);
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    std::vector<BuilderGrip> kinds = Kinds(pits);
    while (!kinds.empty()) {
      const auto drawn =
          std::min(kinds.size() - 1,
                   static_cast<std::size_t>(random.Uniform(0, static_cast<double>(kinds.size()))));
      BuilderGrip grip = kinds[drawn];
      kinds.erase(kinds.begin() + static_cast<std::ptrdiff_t>(drawn));
      const double inclination_rad = random.Uniform(kLeastRad, kMostRad);
      grip.roll_rad *= inclination_rad;
      grip.pitch_rad *= inclination_rad;
      stretches_.push_back({duration_s_, grip});
      duration_s_ += random.Uniform(kLeastHeldS, kMostHeldS);
    }
  }
}

BuilderGrip BuilderScript::At(double t_s) const {
  const double into_s = std::fmod(std::max(0.0, t_s), duration_s_);
  std::size_t i = 0;
  while (i + 1 < stretches_.size() && stretches_[i + 1].from_s <= into_s) ++i;
  const BuilderGrip& before = stretches_[i == 0 ? stretches_.size() - 1 : i - 1].grip;
  BuilderGrip grip = stretches_[i].grip;
  const double share = std::min(1.0, (into_s - stretches_[i].from_s) / kGripChangeS);
  grip.roll_rad = before.roll_rad + share * (grip.roll_rad - before.roll_rad);
  grip.pitch_rad = before.pitch_rad + share * (grip.pitch_rad - before.pitch_rad);
  return grip;
}

Result<Plan> PlanBuilder(bool pits, const Common& common) {
  const auto link = ParseLink(common.link);
  if (!link) return link.error();
  const std::uint64_t seed = DeviceSeed(common, 3);
  const auto script = std::make_shared<const BuilderScript>(seed, pits);
  const auto motion = [script, random = noise::Random(seed)](double t_s) mutable {
    const BuilderGrip grip = script->At(t_s);
    virtual_devices::WiimoteSensors sensors;
    sensors.specific_force_S_mps2 = wrists::InclinedGravity(grip.roll_rad, grip.pitch_rad);
    for (int axis = 0; axis < 3; ++axis) {
      sensors.specific_force_S_mps2[axis] += wrists::SensorModel().noise_mps2 * random.Normal();
    }
    sensors.buttons = static_cast<std::uint16_t>((grip.a ? kButtonA : 0) | (grip.b ? kButtonB : 0));
    return sensors;
  };
  Plan plan;
  plan.devices.push_back(MakeWiimote(common, *link, 3, stream::DeviceRole::kEditor, motion));
  plan.duration_s = common.seconds;
  return plan;
}

}  // namespace footing::stream_client
