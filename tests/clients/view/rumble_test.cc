#include <gtest/gtest.h>

#include "clients/view/app/window.h"
#include "tests/clients/view/made_person.h"
#include "tests/clients/view/made_stream.h"

namespace footing::view {
namespace {

using scene::Sound;
using scene::SoundKind;

Sound Touchdown(int foot, double impact_mps) {
  return {SoundKind::kStep, impact_mps, 0.5, 0, 0, 1, foot};
}

std::uint32_t DeviceOf(const scene::Model& model, stream::DeviceRole role) {
  for (const scene::Device& device : model.devices) {
    if (device.status.role == role) return device.status.device;
  }
  return 0;
}

TEST(Rumble, TheRemoteOfTheFootsSideShakesTheLongerTheHarderItTouched) {
  const scene::Model model = scene::made::ModelAfter(1, {});
  scene::WorldFrame frame = scene::made::TickAt(1, {}).frame.value();
  frame.characters[0].rig = "one";
  const auto commands = RumbleCommands({Touchdown(0, 0.5), Touchdown(1, 2.5)}, frame, model);
  ASSERT_EQ(commands.size(), 2u);
  const v1::SetRumble& left = commands[0].set_rumble();
  const v1::SetRumble& right = commands[1].set_rumble();
  EXPECT_EQ(left.device(), DeviceOf(model, stream::DeviceRole::kLeftHand));
  EXPECT_EQ(right.device(), DeviceOf(model, stream::DeviceRole::kRightHand));
  EXPECT_TRUE(left.on() && right.on());
  EXPECT_GE(left.lease_ms(), 40u);
  EXPECT_GT(right.lease_ms(), left.lease_ms() + 30);
  EXPECT_LE(RumbleCommands({Touchdown(0, 99)}, frame, model)[0].set_rumble().lease_ms(), 120u);
}

TEST(Rumble, NeitherWingsNorAPersonsOwnFeetShakeARemote) {
  const scene::Model model = scene::made::ModelAfter(1, {});
  scene::WorldFrame frame = scene::made::TickAt(1, {}).frame.value();
  frame.characters[0].rig = "one";
  EXPECT_TRUE(RumbleCommands({Touchdown(-1, 1)}, frame, model).empty());
  const scene::WorldFrame person = scene::made::PersonTickAt(1, {}).frame.value();
  EXPECT_TRUE(RumbleCommands({Touchdown(0, 1)}, person, model).empty());
  EXPECT_TRUE(RumbleCommands({Touchdown(0, 1)}, frame, {}).empty()) << "no remote is there";
}

}  // namespace
}  // namespace footing::view
