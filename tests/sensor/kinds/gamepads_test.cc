// Classic Controller and Wii U Pro Controller: golden bytes, and the simulated device from its
// handshake to its samples.
#include <gtest/gtest.h>

#include "common/virtual/devices/controller.h"
#include "common/virtual/devices/wiimote.h"
#include "daemon/sensor/kinds/decoded.h"
#include "daemon/sensor/kinds/kind.h"
#include "daemon/sensor/kinds/pro_controller.h"

namespace footing::kinds {
namespace {

using stream::GamepadSample;
using virtual_devices::Accessory;
using virtual_devices::ProController;
using virtual_devices::ProControllerSensors;
using virtual_devices::Wiimote;
using virtual_devices::WiimoteSensors;

constexpr std::int64_t kStepNs = 5'000'000;

/// 3 s of a device and its host; the newest gamepad sample.
template <typename Device, typename Sample>
std::optional<GamepadSample> Talk(Kind& kind, Device& device, const Sample& sample) {
  std::optional<GamepadSample> newest;
  std::vector<virtual_devices::Report> waiting;
  for (std::int64_t now_ns = kStepNs; now_ns < 600 * kStepNs; now_ns += kStepNs) {
    Outputs outputs;
    kind.Advance(now_ns, outputs);
    for (auto& report : sample(device, now_ns)) waiting.push_back(std::move(report));
    while (!outputs.empty() || !waiting.empty()) {
      for (const auto& output : std::exchange(outputs, {})) {
        for (auto& answer : device.HandleOutput(output)) waiting.push_back(std::move(answer));
      }
      for (const auto& report : std::exchange(waiting, {})) {
        const auto decoded = kind.Take(now_ns, report, outputs);
        EXPECT_TRUE(decoded);
        if (decoded && decoded->gamepad) newest = decoded->gamepad;
      }
    }
  }
  return newest;
}

TEST(Gamepads, AClassicControllersBytesAreSticksTriggersAndButtons) {
  // WiiBrew's page "Classic Controller": left stick 63 and 0 of 6 bits, right stick 31 and 16 of
  // 5 bits, left trigger 31, right trigger 8, A and plus pressed.
  const std::uint8_t bytes[] = {0xff, 0xc0, 0xf0, 0xe8, 0xfb, 0xef};
  const auto counts = reports::DecodeClassic(bytes);
  ASSERT_TRUE(counts);
  const GamepadSample sample = decode::ToGamepad(*counts);
  EXPECT_EQ(sample.left_x, 1);  // (63 - 32) / 31
  EXPECT_EQ(sample.left_y, -1);
  EXPECT_EQ(sample.right_x, 1);  // (31 - 16) / 15
  EXPECT_EQ(sample.right_y, 0);
  EXPECT_EQ(sample.left_trigger, 1);
  EXPECT_DOUBLE_EQ(sample.right_trigger, 8.0 / 31);
  EXPECT_EQ(sample.buttons, stream::kGamepadA | stream::kGamepadPlus);
}

TEST(Gamepads, AProControllersBytesAreSticksAndButtons) {
  // hid-wiimote's and WiiUBrew's layout: left stick right and back, right stick in the middle and
  // front, B and ZR and down, left stick pressed in, battery 3 of 4.
  const std::uint8_t bytes[] = {0x00, 0x0c, 0x00, 0x08, 0x00, 0x04, 0x00, 0x0a, 0xbf, 0xbb, 0xbd};
  const auto counts = pro_controller::DecodeCounts(bytes);
  ASSERT_TRUE(counts);
  EXPECT_EQ(counts->sticks, (std::array<std::uint16_t, 4>{0xc00, 0x800, 0x400, 0xa00}));
  EXPECT_EQ(counts->battery, 3);
  pro_controller::Decoder decoder;
  const auto decoded = decoder.Take(bytes);
  ASSERT_TRUE(decoded.gamepad);
  EXPECT_EQ(decoded.gamepad->left_x, 1);
  EXPECT_EQ(decoded.gamepad->left_y, -1);
  EXPECT_EQ(decoded.gamepad->right_x, 0);
  EXPECT_EQ(decoded.gamepad->right_y, 0.5);
  EXPECT_EQ(decoded.gamepad->buttons, stream::kGamepadB | stream::kGamepadZr |
                                          stream::kGamepadDown | stream::kGamepadLeftStick);
  EXPECT_EQ(decoder.battery_fraction(), 0.75);
  EXPECT_TRUE(decoder.Take(bytes).gamepad->repeated);
}

TEST(Gamepads, ShortAndUnansweredBytesOfAProControllerAreNothing) {
  const std::array<std::uint8_t, 19> silent = [] {
    std::array<std::uint8_t, 19> bytes{};
    bytes.fill(0xff);
    return bytes;
  }();
  EXPECT_FALSE(pro_controller::DecodeCounts(silent));
  const std::array<std::uint8_t, 19> still{};
  for (std::size_t size = 0; size < 11; ++size) {
    EXPECT_FALSE(pro_controller::DecodeCounts(reports::Bytes(still).first(size))) << size;
  }
}

TEST(Gamepads, AClassicInAWiimoteIsPublishedAloneAndBehindAMotionPlus) {
  for (const bool motion_plus : {false, true}) {
    Wiimote wiimote(3);
    if (motion_plus) wiimote.Plug(Accessory::kMotionPlus, 0);
    wiimote.Plug(Accessory::kClassic, 0);
    const auto kind = kinds::MakeKind({}, {0x057e, 0x0306, wiimote.identity().name}, {});
    const auto newest = Talk(*kind, wiimote, [](Wiimote& device, std::int64_t now_ns) {
      WiimoteSensors sensors;
      sensors.classic.left_x = 1;
      sensors.classic.right_y = -1;
      sensors.classic.left_trigger = 1;
      sensors.classic.buttons = reports::kClassicUp | reports::kClassicHome;
      return device.Sample(now_ns, sensors);
    });
    ASSERT_TRUE(newest) << motion_plus;
    // Behind a MotionPlus the lowest bit of the left stick is lost: 62 of 63.
    EXPECT_DOUBLE_EQ(newest->left_x, motion_plus ? 30.0 / 31 : 1);
    EXPECT_EQ(newest->right_y, -1);
    EXPECT_EQ(newest->left_trigger, 1);
    EXPECT_EQ(newest->buttons, stream::kGamepadUp | stream::kGamepadHome);
    EXPECT_EQ(kind->kind(), stream::DeviceKind::kWiimote);
  }
}

TEST(Gamepads, AProControllerIsKnownByItsNameOrByItsIdentity) {
  for (const char* name : {"Nintendo RVL-CNT-01-UC", ""}) {
    ProController device(4);
    EXPECT_EQ(device.identity().product, 0x0330u);
    const auto kind = kinds::MakeKind({}, {0x057e, 0x0330, name}, {});
    const auto newest = Talk(*kind, device, [](ProController& one, std::int64_t) {
      ProControllerSensors sensors;
      sensors.gamepad.left_y = 1;
      sensors.gamepad.right_x = -0.5;
      sensors.gamepad.buttons = reports::kClassicLeftTrigger | reports::kClassicX;
      sensors.right_stick = true;
      std::vector<virtual_devices::Report> reports;
      if (auto report = one.Sample(sensors)) reports.push_back(std::move(*report));
      return reports;
    });
    ASSERT_TRUE(newest) << name;
    EXPECT_EQ(newest->left_y, 1);
    EXPECT_EQ(newest->right_x, -0.5);
    EXPECT_EQ(newest->left_trigger, 1);
    EXPECT_EQ(newest->buttons, stream::kGamepadL | stream::kGamepadX | stream::kGamepadRightStick);
    EXPECT_EQ(kind->kind(), stream::DeviceKind::kProController);
    EXPECT_TRUE(kind->live());
    stream::DeviceStatus status;
    kind->AddTo(status);
    EXPECT_EQ(status.battery_fraction, 1);
    EXPECT_EQ(kind->Note(600 * kStepNs), "");
  }
}

}  // namespace
}  // namespace footing::kinds
