#include "clients/stream/boards.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "clients/stream/forearm.h"
#include "clients/stream/tellings.h"
#include "common/synthetic/random.h"
#include "common/synthetic/sensor.h"

namespace footing::stream_client {
namespace {

using stream::DeviceRole;
namespace sensors = virtual_sensors;

constexpr double kGyroscopeNoiseRadps = 0.003;  // rms an axis: two counts of a slow MotionPlus.

/// What the cells of one board read; a copy begins anew.
StandIn::CornerForces UnderFoot(std::shared_ptr<const Stage> stage, std::size_t foot,
                                sensors::CellErrorConfig errors, std::uint64_t seed) {
  errors.seed = seed;
  return [stage, foot, cells = sensors::CellErrors(errors), last_s = 0.0](double t_s) mutable {
    const auto load = sensors::LoadBoard(stage->boards[foot], stage->FootAt(foot, t_s));
    const sensors::Corners read = cells.Advance(load.corners_n, std::max(0.0, t_s - last_s));
    last_s = t_s;
    return device_models::CornerForces{read[0], read[1], read[2], read[3]};
  };
}

StandIn::WiimoteMotion OnForearm(std::shared_ptr<const Stage> stage, int side, std::uint64_t seed) {
  const auto course = std::make_shared<const ForearmCourse>(FollowForearm(*stage, side));
  return [stage, course, random = synthetic::Random(seed)](double t_s) mutable {
    device_models::WiimoteSensors felt;
    felt.specific_force_S_mps2 = course->ForceAt(*stage, t_s);
    felt.angular_velocity_S_radps = course->TurnAt(*stage, t_s);
    for (int axis = 0; axis < 3; ++axis) {
      felt.specific_force_S_mps2[axis] += synthetic::SensorModel().noise_mps2 * random.Normal();
      felt.angular_velocity_S_radps[axis] += kGyroscopeNoiseRadps * random.Normal();
    }
    return felt;
  };
}

}  // namespace

Result<Plan> PlanBoards(const BoardsOptions& options, const Common& common) {
  if (options.hands != "none" && options.hands != "move" && options.hands != "wiimote") {
    return UsageError("--hands " + options.hands + ": there are none, move and wiimote");
  }
  const auto link = ParseLink(common.link);
  if (!link) return link.error();
  StageOptions wanted = options.stage;
  wanted.seconds = common.seconds;
  auto made = MakeStage(wanted);
  if (!made) return made.error();
  const auto stage = std::make_shared<const Stage>(*std::move(made));
  Plan plan;
  for (const std::size_t foot : {0u, 1u}) {
    const std::uint64_t seed = DeviceSeed(common, foot + 1);
    plan.devices.emplace_back(device_models::BalanceBoard(seed),
                              UnderFoot(stage, foot, options.errors, seed + 700),
                              foot == 0 ? DeviceRole::kLeftBoard : DeviceRole::kRightBoard,
                              device_models::BoardLink(*link, seed + 500));
  }
  if (options.hands == "wiimote") {
    for (const int side : {0, 1}) {
      const std::uint64_t device = 3 + static_cast<std::uint64_t>(side);
      plan.devices.push_back(MakeWiimote(
          common, *link, device, side == 0 ? DeviceRole::kLeftHand : DeviceRole::kRightHand,
          OnForearm(stage, side, DeviceSeed(common, device) + 700), {true, false}));
    }
  }
  TellTheBody(stage, options.hands, options.hand_noise_m, common, plan);
  return plan;
}

}  // namespace footing::stream_client
