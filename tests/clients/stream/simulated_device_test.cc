#include "clients/stream/simulated_device.h"

#include <gtest/gtest.h>

#include <cmath>

#include "clients/stream/plan.h"

namespace footing::stream_client {
namespace {

using virtual_devices::Report;

Common Ideal() {
  Common common;
  common.link = "ideal";
  return common;
}

Report Write(std::uint32_t address, std::uint8_t value) {
  Report report(22, 0);
  report[0] = 0x16;
  report[1] = 0x04;
  report[2] = static_cast<std::uint8_t>(address >> 16);
  report[3] = static_cast<std::uint8_t>(address >> 8);
  report[4] = static_cast<std::uint8_t>(address);
  report[5] = 1;
  report[6] = value;
  return report;
}

/// The extension's bytes of report 0x35.
std::vector<std::uint8_t> PacketOf(SimulatedDevice& device, double t_s) {
  const auto reports = device.Deliver(t_s);
  if (reports.size() != 1 || reports[0][0] != 0x35) return {};
  return {reports[0].begin() + 6, reports[0].begin() + 12};
}

TEST(SimulatedDevice, TheJoystickUsersNunchukStandsInFrontWhileWalking) {
  auto plan = PlanUser("walk", "joystick", Ideal());
  ASSERT_TRUE(plan);
  ASSERT_EQ(plan->devices.size(), 1u);
  SimulatedDevice& device = plan->devices[0];
  EXPECT_TRUE(device.Deliver(0).empty());  // No mode is set.
  device.HandleOutput(0, Write(0xa400f0, 0x55));
  device.HandleOutput(0, Write(0xa400fb, 0x00));
  device.HandleOutput(0, Report{0x12, 0x04, 0x35});
  const auto resting = PacketOf(device, 1);  // The script begins with 2 s of rest.
  const auto walking = PacketOf(device, 10);
  ASSERT_EQ(resting.size(), 6u);
  ASSERT_EQ(walking.size(), 6u);
  EXPECT_NEAR(walking[0], resting[0], 1);
  EXPECT_GT(walking[1], resting[1] + 30);
}

TEST(SimulatedDevice, TheJoystickUserJumpsByButtonA) {
  auto plan = PlanUser("jump", "joystick", Ideal());
  ASSERT_TRUE(plan);
  plan->devices[0].HandleOutput(0, Report{0x12, 0x04, 0x30});
  int pressed = 0;
  for (int i = 0; i < 100; ++i) {
    for (const Report& report : plan->devices[0].Deliver(10 + i * 0.01))
      pressed += report[2] >> 3 & 1;
  }
  EXPECT_GT(pressed, 10);
  EXPECT_LT(pressed, 40);
}

TEST(SimulatedDevice, AMotionPlusIsThereWhenAskedForAndTurnsWithTheInclination) {
  EXPECT_EQ(PlanUser("turn", "wrist", Ideal())
                .value()
                .devices[0]
                .HandleOutput(0, Report{0x17, 0x04, 0xa6, 0x00, 0xfa, 0x00, 0x06})[0][3],
            0xf7);
  auto plan = PlanUser("turn", "wrist", Ideal(), {.motion_plus = true});
  ASSERT_TRUE(plan);
  SimulatedDevice& device = plan->devices[0];
  device.HandleOutput(0, Write(0xa600fe, 0x04));
  EXPECT_EQ(device.Deliver(0.1).size(), 1u);  // It is there: an unasked status.
  device.HandleOutput(0.1, Report{0x12, 0x04, 0x35});
  PacketOf(device, 0.2);
  PacketOf(device, 0.3);
  const auto roll = [&](double t_s) {
    const auto packet = PacketOf(device, t_s);
    return packet.size() == 6 ? (packet[4] >> 2) << 8 | packet[1] : 0;
  };
  // The hands come to an inclination of 20 degrees within 0.15 s after two seconds of rest.
  const int still = roll(1);
  EXPECT_NEAR(roll(1.5), still, 1);
  EXPECT_GT(std::abs(roll(2.075) - still), 500);
  EXPECT_NEAR(roll(10), still, 1);
}

TEST(SimulatedDevice, AfterARestartItIsFreshFromItsBox) {
  auto plan = PlanUser("walk", "wrist", Ideal());
  SimulatedDevice& device = plan.value().devices[0];
  device.HandleOutput(0, Report{0x12, 0x04, 0x31});
  device.HandleOutput(0, Report{0x11, 0x31});
  EXPECT_EQ(device.Changes(0), device.identity().serial + " LEDs 3 rumble on");
  EXPECT_EQ(device.Changes(0), "");
  EXPECT_EQ(device.Deliver(1).size(), 1u);
  device.Restart();
  EXPECT_TRUE(device.Deliver(1).empty());
  EXPECT_EQ(device.Changes(0), "");
}

TEST(SimulatedDevice, AMoveNeedsNoModeAnswersFeaturesAndGoesDark) {
  const virtual_devices::LinkConfig link =
      virtual_devices::WiimoteLink(virtual_devices::LinkQuality::kIdeal, 1);
  SimulatedDevice device(
      virtual_devices::PsMove(1, virtual_devices::MoveModel::kZcm1),
      [](double) { return virtual_devices::MoveSensors(); }, stream::DeviceRole::kRightHand, link);
  ASSERT_EQ(device.Deliver(0).size(), 1u);
  EXPECT_EQ(device.Feature(0x10, 49).size(), 49u);
  EXPECT_TRUE(device.Feature(0x77, 49).empty());
  device.HandleOutput(1, Report{0x06, 0, 0x12, 0x34, 0x56, 0, 0, 0, 0});
  EXPECT_EQ(device.Changes(1), device.identity().serial + " sphere #123456");
  EXPECT_EQ(device.Changes(7), device.identity().serial + " sphere #000000");
}

}  // namespace
}  // namespace footing::stream_client
