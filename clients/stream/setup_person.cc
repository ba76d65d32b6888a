#include "clients/stream/setup_person.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "common/board/layout.h"
#include "common/runtime/log.h"
#include "common/stream/user_interface.h"
#include "common/wire/wire.h"

namespace footing::stream_client {
namespace {

using stream::DeviceRole;
using stream::Gesture;
using stream::UserInterface;

constexpr auto kThreeSteps = std::chrono::milliseconds(2300);
/// The last effects on the devices are still looked at when nothing is asked for any more.
constexpr auto kSetupOver = std::chrono::seconds(3);
constexpr std::size_t kMostAsked = 10'000;

bool IsLeft(DeviceRole role) {
  return role == DeviceRole::kLeftHand || role == DeviceRole::kLeftLeg ||
         role == DeviceRole::kLeftBoard;
}

/// Lines of SetupBody::Do for a gesture; none for one that is not the body's.
std::vector<std::string> LinesFor(Gesture gesture, DeviceRole role) {
  const std::string side = IsLeft(role) ? "left" : "right";
  switch (gesture) {
    case Gesture::kHoldStill:
      return {"still"};
    case Gesture::kStepOff:
      return {"still", "off"};
    case Gesture::kStepOn:
      return {"still", side};
    case Gesture::kStand:
      return {"still", "both"};
    case Gesture::kLean:
      return {"lean"};
    case Gesture::kShake:
      return {"shake " + side};
    case Gesture::kTakeSteps:
      return {"walk"};
    case Gesture::kSwitchOn:
    case Gesture::kUnspecified:
      break;
  }
  return {};
}

}  // namespace

SetupPerson::SetupPerson(boost::asio::io_context& io, std::shared_ptr<SetupBody> body,
                         std::string rig, std::shared_ptr<SetupRecord> record,
                         std::function<void()> on_end)
    : body_(std::move(body)),
      rig_(std::move(rig)),
      record_(std::move(record)),
      on_end_(std::move(on_end)),
      steps_(io),
      over_(io) {}

void SetupPerson::See(const v1::Tick& tick) {
  if (!tick.has_setup()) return;
  for (const v1::RigSetup& rig : tick.setup().rigs()) {
    if (rig.rig() == rig_) Follow(wire::FromProto(rig));
  }
}

void SetupPerson::Follow(const stream::RigSetup& setup) {
  const stream::BoardLayout layout = board::LayoutOr(setup.layout);
  body_->Lay(layout.left.yaw_rad, layout.right.yaw_rad);
  if (!setup.prompt) {
    if (!item_.empty()) End();
    return;
  }
  if (setup.prompt->number == number_ && !item_.empty()) return;
  number_ = setup.prompt->number;
  item_ = setup.prompt->item;
  over_.cancel();
  log::Info("asked for " + item_ + ": " + setup.prompt->text);
  const bool performed = Perform(*setup.prompt);
  if (record_->asked.size() < kMostAsked) record_->asked.push_back({*setup.prompt, performed});
}

bool SetupPerson::Perform(const stream::SetupPrompt& prompt) {
  steps_.cancel();
  const auto lines = LinesFor(prompt.gesture, prompt.role);
  for (const std::string& line : lines) body_->Do(line);
  if (prompt.gesture == Gesture::kTakeSteps) {
    steps_.expires_after(kThreeSteps);
    steps_.async_wait([body = body_](const boost::system::error_code& error) {
      if (!error) body->Do("still");
    });
  }
  // The devices are on from the beginning.
  return !lines.empty() || prompt.gesture == Gesture::kSwitchOn;
}

void SetupPerson::End() {
  item_.clear();
  over_.expires_after(kSetupOver);
  over_.async_wait([this](const boost::system::error_code& error) {
    if (error) return;
    ++record_->setups;
    log::Info("the setup has ended");
    on_end_();
  });
}

Result<SetupPersonPlan> PlanSetupPerson(const SetupPersonOptions& options, const Common& common) {
  const auto link = ParseLink(common.link);
  if (!link) return link.error();
  const UserInterface interface = stream::UserInterfaceNamed(options.interface);
  if (interface == UserInterface::kUnspecified && !options.interface.empty()) {
    return UsageError("--interface " + options.interface +
                      ": unknown interface; there are: " + stream::UserInterfaceNames());
  }
  const bool boards_only = interface == UserInterface::kBoards;
  const bool joystick = interface == UserInterface::kJoystick;
  const bool all = interface == UserInterface::kUnspecified;
  const int boards = options.boards.value_or(all || boards_only ? 2 : 0);
  const int remotes = boards_only ? 0 : joystick ? 1 : 2;
  if (boards + remotes == 0) {
    return UsageError("--interface boards --boards 0: there is no device; leave out one of them");
  }
  const auto place = interface == UserInterface::kLeg ? SetupBody::Place::kShins
                     : options.strapped               ? SetupBody::Place::kWrists
                                                      : SetupBody::Place::kHands;
  SetupPersonPlan planned;
  planned.body = std::make_shared<SetupBody>(place, options.mass_kg, boards);
  const auto side_asked = [&](int side) { return options.jumbled ? 1 - side : side; };
  for (int side = 0; side < boards; ++side) {
    const std::uint64_t seed = DeviceSeed(common, static_cast<std::uint64_t>(side) + 1);
    const int asked = boards == 2 ? side_asked(side) : side;
    planned.plan.devices.emplace_back(
        virtual_devices::BalanceBoard(seed),
        [body = planned.body, side](double t_s) { return body->Board(side, t_s); },
        asked == 0 ? DeviceRole::kLeftBoard : DeviceRole::kRightBoard,
        virtual_devices::BoardLink(*link, seed + 500));
  }
  for (int side = 2 - remotes; side < 2; ++side) {
    const auto feels = [body = planned.body, side](double t_s) {
      virtual_devices::WiimoteSensors sensors;
      sensors.specific_force_S_mps2 = body->Limb(side, t_s);
      return sensors;
    };
    const DeviceRole role = planned.body->Role(remotes == 2 ? side_asked(side) : side);
    planned.plan.devices.push_back(MakeWiimote(common, *link, static_cast<std::uint64_t>(side) + 3,
                                               role, feels, {.nunchuk = joystick}));
  }
  planned.plan.duration_s = common.seconds;
  return planned;
}

}  // namespace footing::stream_client
