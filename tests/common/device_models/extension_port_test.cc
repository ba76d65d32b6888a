#include <gtest/gtest.h>

#include <algorithm>

#include "common/device_models/wiimote.h"

namespace footing::device_models {
namespace {

constexpr std::int64_t kMs = 1'000'000;

/// A Wiimote, its clock, and the host's side of the protocol.
class Port : public testing::Test {
 protected:
  explicit Port(const WiimoteOptions& options = {}) : wiimote(3, options) {}

  std::vector<Report> Send(const Report& report) { return wiimote.HandleOutput(now_ns, report); }
  std::vector<Report> Write(std::uint32_t address, std::uint8_t byte) {
    Report report(22, 0);
    report[0] = 0x16;
    report[1] = 0x04;
    report[2] = static_cast<std::uint8_t>(address >> 16);
    report[3] = static_cast<std::uint8_t>(address >> 8);
    report[4] = static_cast<std::uint8_t>(address);
    report[5] = 1;
    report[6] = byte;
    return Send(report);
  }
  /// Six bytes; empty for an error.
  Report Identity(std::uint32_t page) {
    const auto answers = Send({0x17, 0x04, static_cast<std::uint8_t>(page >> 8),
                               static_cast<std::uint8_t>(page), 0xfa, 0x00, 0x06});
    const Report& reply = answers.back();
    if ((reply[3] & 0x0f) != 0) return {};
    return {reply.begin() + 6, reply.begin() + 12};
  }
  void SetMode(std::uint8_t mode) { Send({0x12, 0x04, mode}); }
  /// The six extension bytes of the next report 0x35.
  Report Packet() {
    now_ns += 10 * kMs;
    const auto reports = wiimote.Sample(now_ns, sensors);
    if (reports.empty() || reports.back()[0] != 0x35) return {};
    return {reports.back().begin() + 6, reports.back().begin() + 12};
  }
  void Initialise() {
    Write(0xa400f0, 0x55);
    Write(0xa400fb, 0x00);
  }

  Wiimote wiimote;
  WiimoteSensors sensors;
  std::int64_t now_ns = 0;
};

class PortWithMotionPlusInside : public Port {
 protected:
  PortWithMotionPlusInside() : Port({.tr = true}) {}
};

bool IsStatus(const Report& report, bool extension) {
  return report[0] == 0x20 && ((report[3] & 0x02) != 0) == extension;
}

TEST_F(Port, PluggingANunchukInStopsTheDataUntilAModeIsSet) {
  SetMode(0x35);
  EXPECT_EQ(wiimote.Sample(now_ns, sensors).size(), 1u);
  const auto said = wiimote.Plug(Accessory::kNunchuk, now_ns);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_TRUE(IsStatus(said[0], true));
  EXPECT_TRUE(wiimote.Sample(now_ns, sensors).empty());
  SetMode(0x35);
  EXPECT_EQ(wiimote.Sample(now_ns, sensors).size(), 1u);
}

TEST_F(Port, ANunchukIsReadableOnlyAfterTheKey) {
  wiimote.Plug(Accessory::kNunchuk, now_ns);
  EXPECT_EQ(Identity(0xa400), Report(6, 0xff));
  SetMode(0x35);
  EXPECT_EQ(Packet(), Report(6, 0xff));
  Initialise();
  EXPECT_EQ(Identity(0xa400), (Report{0x00, 0x00, 0xa4, 0x20, 0x00, 0x00}));
  EXPECT_NE(Packet(), Report(6, 0xff));
}

TEST_F(Port, APulledNunchukIsSaidAndGivesErrors) {
  wiimote.Plug(Accessory::kNunchuk, now_ns);
  Initialise();
  const auto said = wiimote.Pull(now_ns);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_TRUE(IsStatus(said[0], false));
  EXPECT_TRUE(Identity(0xa400).empty());
  wiimote.Plug(Accessory::kClassic, now_ns);
  Initialise();
  EXPECT_EQ(Identity(0xa400)[4], 0x01);
}

TEST_F(Port, AnInactiveMotionPlusAnswersAtItsOwnPageAndIsNotSaid) {
  EXPECT_TRUE(Identity(0xa600).empty());
  EXPECT_TRUE(wiimote.Plug(Accessory::kMotionPlus, now_ns).empty());
  EXPECT_EQ(Identity(0xa600), (Report{0x00, 0x00, 0xa6, 0x20, 0x00, 0x05}));
}

TEST_F(Port, SwitchingAMotionPlusOnMovesTheDetectPin) {
  wiimote.Plug(Accessory::kMotionPlus, now_ns);
  const auto answers = Write(0xa600fe, 0x04);
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_EQ(answers[0][0], 0x22);
  EXPECT_TRUE(IsStatus(answers[1], false));
  EXPECT_TRUE(Identity(0xa400).empty()) << "the dead window";
  now_ns += 25 * kMs;
  const auto later = wiimote.Sample(now_ns, sensors);
  ASSERT_EQ(later.size(), 1u);
  EXPECT_TRUE(IsStatus(later[0], true));
  EXPECT_EQ(Identity(0xa400), (Report{0x00, 0x00, 0xa4, 0x20, 0x04, 0x05}));
  EXPECT_TRUE(Identity(0xa600).empty());
  SetMode(0x35);
  EXPECT_EQ(Packet(), Report(6, 0xff)) << "rubbish";
  EXPECT_EQ(Packet(), Report(6, 0x00)) << "rubbish";
  for (int i = 0; i < 4; ++i) EXPECT_EQ(Packet()[5] & 0x03, 0x02);
}

TEST_F(Port, ANunchukIsPassedThroughInTurns) {
  wiimote.Plug(Accessory::kMotionPlus, now_ns);
  wiimote.Plug(Accessory::kNunchuk, now_ns);
  Initialise();
  Write(0xa600fe, 0x05);
  now_ns += 25 * kMs;
  wiimote.Sample(now_ns, sensors);
  SetMode(0x35);
  Packet();
  Packet();
  int of_nunchuk = 0;
  for (int i = 0; i < 10; ++i) {
    const Report packet = Packet();
    EXPECT_EQ(packet[4] & 0x01, 1) << "a child is there";
    if ((packet[5] & 0x02) == 0) ++of_nunchuk;
  }
  EXPECT_EQ(of_nunchuk, 5);
  EXPECT_TRUE(wiimote.PullBehind(now_ns).empty()) << "only the packets tell";
  for (int i = 0; i < 4; ++i) {
    const Report packet = Packet();
    EXPECT_EQ(packet[4] & 0x01, 0);
    EXPECT_EQ(packet[5] & 0x02, 2);
  }
}

TEST_F(Port, TheKeySwitchesAMotionPlusOffAndFindsWhatIsBehind) {
  wiimote.Plug(Accessory::kMotionPlus, now_ns);
  wiimote.Plug(Accessory::kNunchuk, now_ns);
  Write(0xa600fe, 0x05);
  now_ns += 25 * kMs;
  wiimote.Sample(now_ns, sensors);
  EXPECT_TRUE(wiimote.motion_plus_active());
  Write(0xa400f0, 0x55);
  EXPECT_FALSE(wiimote.motion_plus_active());
  now_ns += 25 * kMs;
  ASSERT_EQ(wiimote.Sample(now_ns, sensors).size(), 1u);
  Initialise();
  EXPECT_EQ(Identity(0xa400), (Report{0x00, 0x00, 0xa4, 0x20, 0x00, 0x00}));
  EXPECT_EQ(Identity(0xa600)[2], 0xa6);
}

TEST_F(Port, APulledAdapterTakesWhatIsBehindItAlong) {
  wiimote.Plug(Accessory::kMotionPlus, now_ns);
  wiimote.Plug(Accessory::kNunchuk, now_ns);
  Write(0xa600fe, 0x05);
  const auto said = wiimote.Pull(now_ns);
  ASSERT_FALSE(said.empty());
  EXPECT_TRUE(IsStatus(said.back(), false));
  EXPECT_TRUE(Identity(0xa600).empty());
  EXPECT_TRUE(Identity(0xa400).empty());
  now_ns += 100 * kMs;
  EXPECT_TRUE(wiimote.Sample(now_ns, sensors).empty());
}

TEST_F(PortWithMotionPlusInside, ItCannotBePulled) {
  EXPECT_EQ(wiimote.identity().product, 0x0330);
  wiimote.Pull(now_ns);
  EXPECT_EQ(Identity(0xa600), (Report{0x01, 0x00, 0xa6, 0x20, 0x00, 0x05}));
}

TEST_F(Port, FastTurnsUseTheFastRangeOfTheirAxisAlone) {
  wiimote.Plug(Accessory::kMotionPlus, now_ns);
  Write(0xa600fe, 0x04);
  now_ns += 25 * kMs;
  wiimote.Sample(now_ns, sensors);
  SetMode(0x35);
  Packet();
  Packet();
  sensors.angular_velocity_S_radps = {0, 0, 12};  // Yaw, 690 degrees/s.
  Report packet = Packet();
  EXPECT_EQ(packet[3] & 0x03, 0x01) << "pitch slow, yaw not";
  EXPECT_EQ(packet[4] & 0x02, 0x02) << "roll slow";
  sensors.angular_velocity_S_radps = {12, 0, 0};  // Pitch.
  packet = Packet();
  EXPECT_EQ(packet[3] & 0x03, 0x02);
}

TEST_F(Port, TheCameraSendsWhatItSeesWhenItIsOn) {
  sensors.camera[0] = CameraPoint{512, 384, 3};
  SetMode(0x33);
  auto report = wiimote.Sample(now_ns, sensors).at(0);
  EXPECT_EQ(report[6], 0xff) << "not on";
  Send({0x13, 0x04});
  Send({0x1a, 0x04});
  Write(0xb00030, 0x08);
  Write(0xb00033, 0x03);
  report = wiimote.Sample(now_ns, sensors).at(0);
  EXPECT_EQ(report[6], 0x00);
  EXPECT_EQ(report[7], 384 & 0xff);
  EXPECT_EQ(report[8], 0x01 << 6 | 0x02 << 4 | 3);
  EXPECT_EQ(report[9], 0xff);
}

TEST_F(Port, TheInterleavedModeSendsHalvesInTurn) {
  SetMode(0x3e);
  EXPECT_EQ(wiimote.Sample(now_ns, sensors).at(0)[0], 0x3e);
  EXPECT_EQ(wiimote.Sample(now_ns, sensors).at(0)[0], 0x3f);
  EXPECT_EQ(wiimote.Sample(now_ns, sensors).at(0)[0], 0x3e);
}

}  // namespace
}  // namespace footing::device_models
