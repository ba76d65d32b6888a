#include "daemon/offline/eval/user_devices.h"

#include <cmath>

#include "common/board/layout.h"
#include "common/stream/interface_roles.h"
#include "common/base/units.h"

namespace footing::eval {
namespace {

using stream::DeviceRole;
using stream::TurnSource;
using stream::UserInterface;

constexpr double kBoardHz = 60;
constexpr double kBoardGapM = 0.02;
/// A Nunchuk's stick has about so many counts from its centre to the rim.
constexpr double kStickCounts = 95;
/// White noise of a board's cell, kg; and its gains' spread (Bartlett, Ting & Bingham 2014).
constexpr double kCellNoiseKg = 0.05;
constexpr double kCellGainSpread = 0.01;

/// Device numbers are those of the roles.
std::uint32_t DeviceOf(DeviceRole role) { return static_cast<std::uint32_t>(role); }

/// Boards have no features.
std::vector<features::Member> MembersFor(UserInterface interface, TurnSource turn_by) {
  std::vector<features::Member> members;
  if (interface == UserInterface::kBoards) return members;
  for (const DeviceRole role : stream::RolesOf(interface, turn_by)) {
    members.push_back({DeviceOf(role), role});
  }
  return members;
}

}  // namespace

UserDevices::UserDevices(UserInterface interface, TurnSource turn_by, std::uint64_t seed)
    : interface_(interface), random_(seed), chain_(MembersFor(interface, turn_by)) {
  for (const std::uint64_t board : {1u, 2u}) {
    cells_.emplace_back(virtual_sensors::CellErrorConfig{
        .gain_spread = kCellGainSpread, .noise_kg = kCellNoiseKg, .seed = seed + board});
  }
}

void UserDevices::TakeRemotes(const users::Felt& felt) {
  const std::int64_t now_ns = SecondsToNanoseconds(static_cast<double>(ticks_) * kTickS);
  std::uint32_t mounted_roles = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(felt.remote_count); ++i) {
    const users::FeltRemote& remote = felt.remotes[i];
    const auto reading = wrists::Read(sensor_, remote.specific_force_S_mps2, random_);
    chain_.Add(DeviceOf(remote.role), now_ns, reading.specific_force_mps2, reading.clipped_axes);
    // Shins and the trunk have a mounting; hands and the head need none.
    const bool mounted = remote.role == DeviceRole::kLeftLeg ||
                         remote.role == DeviceRole::kRightLeg || remote.role == DeviceRole::kTrunk;
    if (mounted) mounted_roles |= stream::RoleBit(remote.role);
  }
  mapping::TakeFeatures(chain_.Compute(now_ns), mounted_roles, inputs_);
}

void UserDevices::TakeStick(const users::Felt& felt) {
  mapping::StickInput& stick = inputs_.stick;
  stick.present = true;
  stick.x = std::round(felt.stick_x * kStickCounts) / kStickCounts;
  stick.y = std::round(felt.stick_y * kStickCounts) / kStickCounts;
  if (felt.button_a && !stick.pressed) ++stick.presses;
  stick.pressed = felt.button_a;
}

void UserDevices::TakeBoards(const users::Felt& felt) {
  const double now_s = static_cast<double>(ticks_) * kTickS;
  if (now_s < board_due_s_) return;
  board_due_s_ += 1 / kBoardHz;
  const auto places = virtual_sensors::OneFootEach(kBoardGapM);
  for (std::size_t foot = 0; foot < 2; ++foot) {
    const auto load = virtual_sensors::LoadBoard(places[foot], felt.feet[foot]);
    const auto read = cells_[foot].Advance(load.corners_n, 1 / kBoardHz);
    const board::PlateReading reading = plates_[foot].Advance({read[0], read[1], read[2], read[3]});
    mapping::BoardInput& board = foot == 0 ? inputs_.left_board : inputs_.right_board;
    board = {.present = true, .corners_n = read, .cop_valid = reading.cop_valid};
    if (!reading.cop_valid) continue;
    const virtual_sensors::BoardPlace& place = places[foot];
    const Eigen::Vector2d cop_W_m = board::InWorld(
        {place.middle_m.x(), place.middle_m.y(), place.yaw_rad}, reading.cop_x_m, reading.cop_y_m);
    board.cop_x_m = cop_W_m.x();
    board.cop_y_m = cop_W_m.y();
  }
}

mapping::Inputs UserDevices::Take(const users::Felt& felt) {
  ++ticks_;
  switch (interface_) {
    case UserInterface::kUnspecified:
    case UserInterface::kWrist:
    case UserInterface::kArm:
    case UserInterface::kLeg:
      TakeRemotes(felt);
      break;
    case UserInterface::kJoystick:
      TakeStick(felt);
      break;
    case UserInterface::kBoards:
      TakeBoards(felt);
      break;
  }
  return inputs_;
}

}  // namespace footing::eval
