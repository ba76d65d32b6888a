#include "clients/stream/live_user.h"

#include <algorithm>
#include <utility>

#include "common/stream/interface_roles.h"
#include "common/stream/leg_turn.h"
#include "common/virtual/devices/random.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/devices/accelerometer.h"
#include "common/wire/scalar.h"
#include "common/wire/wire.h"

namespace footing::stream_client {
namespace {

using stream::DeviceRole;
using stream::TurnSource;
using stream::UserInterface;

/// Interval of the user's decisions, s.
constexpr double kLookS = 0.01;
constexpr double kBoardGapM = 0.02;
constexpr std::uint16_t kJumpButton = 0x0008;

/// What the remote with this place among those worn feels, with an accelerometer's noise.
SimulatedDevice::WiimoteMotion RemoteOf(std::shared_ptr<LiveUser> user, std::size_t index,
                                        std::uint64_t seed) {
  return [user = std::move(user), index, random = noise::Random(seed)](double t_s) mutable {
    const users::Felt& felt = user->At(t_s);
    virtual_devices::WiimoteSensors sensors;
    if (index < static_cast<std::size_t>(felt.remote_count)) {
      sensors.specific_force_S_mps2 = felt.remotes[index].specific_force_S_mps2;
    }
    for (int axis = 0; axis < 3; ++axis) {
      sensors.specific_force_S_mps2[axis] += wrists::SensorModel().noise_mps2 * random.Normal();
    }
    sensors.buttons = felt.button_a ? kJumpButton : 0;
    sensors.nunchuk.stick_x = felt.stick_x;
    sensors.nunchuk.stick_y = felt.stick_y;
    return sensors;
  };
}

SimulatedDevice::CornerForces BoardOf(std::shared_ptr<LiveUser> user, std::size_t foot) {
  return [user = std::move(user), foot](double t_s) {
    const auto places = virtual_sensors::OneFootEach(kBoardGapM);
    const auto load = virtual_sensors::LoadBoard(places[foot], user->At(t_s).feet[foot]);
    const virtual_sensors::Corners& n = load.corners_n;
    return virtual_devices::CornerForces{n[0], n[1], n[2], n[3]};
  };
}

}  // namespace

LiveUser::LiveUser(UserInterface interface, TurnSource turn_by, const users::Style& style,
                   std::uint64_t seed, std::vector<users::Act> acts)
    : acts_(std::move(acts)),
      driver_(users::AbilityWith(interface, turn_by), style, seed),
      person_(interface, style, seed, turn_by) {}

void LiveUser::See(const v1::Tick& tick) {
  if (tick.has_track()) {
    track_ = wire::FromProto(tick.track());
    driver_.SeeTrack(track_);
  }
  if (tick.characters().characters_size() == 0) return;
  const v1::Character& character = tick.characters().characters(0);
  const stream::GaitState gait = wire::FromProto(character.gait());
  const Eigen::Vector3d com_m = wire::FromProto(character.com_m());
  seen_ = {.p_W_m = com_m.head<2>(),
           .com_m = com_m.z(),
           .heading_rad = gait.heading_rad,
           .speed_mps = gait.speed_mps,
           .steps = gait.steps,
           .falls = gait.falls,
           .gait = gait.gait,
           .trial = wire::FromProto(character.trial()).progress};
  for (std::size_t i = 0; i < track_.tasks.size(); ++i) {  // A trial's task is published by name.
    if (track_.tasks[i].name == character.trial().task()) seen_.trial.task = static_cast<int>(i);
  }
  seen_s_ = time_s_;
}

const users::Felt& LiveUser::At(double t_s) {
  if (t_s < at_s_ - 1) before_s_ = time_s_;  // The devices have connected again.
  at_s_ = t_s;
  const double until_s = before_s_ + t_s;
  while (time_s_ + kLookS <= until_s) {
    time_s_ += kLookS;
    seen_.time_s = time_s_;
    wanted_ = Want();
    person_.Advance(time_s_, wanted_);
  }
  return person_.felt();
}

users::Intention LiveUser::Want() {
  if (!acts_.empty()) return users::WantedAt(acts_, time_s_);
  return time_s_ - seen_s_ < kBlindS ? driver_.Want(seen_) : users::Intention{};
}

Result<LiveUserPlan> PlanLiveUser(const LiveUserOptions& options, const Common& common,
                                  std::uint64_t style_seed) {
  const auto link = ParseLink(common.link);
  if (!link) return link.error();
  const UserInterface named = stream::UserInterfaceNamed(options.interface);
  const TurnSource turns = stream::LegTurnSourceNamed(options.turn_by);
  if (turns == TurnSource::kUnspecified) {
    return UsageError("unknown --turn-by " + options.turn_by + "; there are: head, feet, trunk");
  }
  const std::vector<DeviceRole> roles = stream::RolesOf(named, turns);
  if (roles.empty()) {
    return UsageError("unknown --interface " + options.interface +
                      "; there are: " + stream::UserInterfaceNames());
  }
  std::optional<users::GripWish> grip;
  if (options.grip_deg) {
    const auto parsed = users::ParseGrip(*options.grip_deg, options.grip_way, named);
    if (!parsed) return parsed.error();
    grip = *parsed;
  }
  std::vector<users::Act> acts;
  if (options.ranges) acts = users::RangeActs(named, turns);
  if (options.ranges && acts.empty()) {
    return UsageError(
        "--ranges: the user of a joystick has no range of its own; there are: wrist, "
        "arm, leg, boards");
  }
  const users::Style style = users::StyleOf(style_seed, named, grip, options.style);
  LiveUserPlan live{.plan = {},
                    .user = std::make_shared<LiveUser>(named, turns, style, style_seed, acts)};
  for (std::size_t i = 0; i < roles.size(); ++i) {
    const std::uint64_t device = i + 1;
    const std::uint64_t seed = DeviceSeed(common, device);
    if (named == UserInterface::kBoards) {
      live.plan.devices.emplace_back(virtual_devices::BalanceBoard(seed), BoardOf(live.user, i),
                                     roles[i], virtual_devices::BoardLink(*link, seed + 500));
      continue;
    }
    live.plan.devices.push_back(
        MakeWiimote(common, *link, device, roles[i], RemoteOf(live.user, i, seed),
                    {.motion_plus = false, .nunchuk = named == UserInterface::kJoystick}));
  }
  live.plan.duration_s = common.seconds;
  return live;
}

}  // namespace footing::stream_client
