
#include <gtest/gtest.h>

#include "common/virtual/devices/controller.h"
#include "common/virtual/devices/wiimote.h"
#include "daemon/sensor/reports/board_calibration.h"
#include "tests/sensor/reports/fixture.h"

namespace footing::handshake {
namespace {

using stream::CalibrationOrigin;
using stream::DeviceKind;
using virtual_devices::BalanceBoard;
using virtual_devices::Wiimote;

Conversation<Wiimote> WithWiimote() {
  Conversation<Wiimote> talk(Wiimote(5), "Nintendo RVL-CNT-01");
  talk.sample = [](Wiimote& wiimote) { return wiimote.Sample({0, 0, -9.81}); };
  return talk;
}

Conversation<BalanceBoard> WithBoard(const std::string& name) {
  Conversation<BalanceBoard> talk(BalanceBoard(5), name);
  talk.sample = [](BalanceBoard& board) { return board.Sample({100, 100, 100, 100}); };
  return talk;
}

TEST(Handshake, AWiimoteIsLiveWithItsOwnCalibration) {
  auto talk = WithWiimote();
  talk.Advance(0.1);
  ASSERT_TRUE(talk.handshake().live());
  EXPECT_EQ(talk.kind().kind(), DeviceKind::kWiimote);
  EXPECT_EQ(talk.handshake().mode(), 0x31);
  EXPECT_EQ(talk.status().calibration, CalibrationOrigin::kDevice);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(talk.handshake().acceleration().zero_counts[axis],
              talk.device().axes()[axis].zero_counts);
    EXPECT_EQ(talk.handshake().acceleration().one_g_counts[axis],
              talk.device().axes()[axis].one_g_counts);
  }
  EXPECT_EQ(talk.device().controller().mode(), 0x31);
  EXPECT_TRUE(talk.device().controller().continuous());
  EXPECT_EQ(talk.Note(), "");
}

TEST(Handshake, ABoardIsLiveWithItsOwnCalibrationEvenWithoutAName) {
  for (const char* name : {"Nintendo RVL-WBC-01", ""}) {
    auto talk = WithBoard(name);
    talk.Advance(0.1);
    ASSERT_TRUE(talk.handshake().live());
    EXPECT_EQ(talk.kind().kind(), DeviceKind::kBalanceBoard);
    EXPECT_EQ(talk.handshake().mode(), 0x34);
    EXPECT_EQ(talk.status().calibration, CalibrationOrigin::kDevice);
    const auto& blocks = talk.handshake().blocks();
    const auto calibration = calibration::ParseBoard(blocks.at(0), blocks.at(1));
    for (std::size_t corner = 0; corner < 4; ++corner) {
      for (std::size_t point = 0; point < 3; ++point) {
        EXPECT_EQ(calibration.counts[point][corner], talk.device().points()[corner][point]);
      }
    }
  }
}

TEST(Handshake, OneQuestionIsOutAtATime) {
  auto talk = WithBoard("Nintendo RVL-WBC-01");
  int open = 0;
  int most = 0;
  talk.on_output = [&](reports::OutputReport& output) {
    // Nobody answers the two that silence the speaker.
    if (output[0] != 0x14 && output[0] != 0x19) most = std::max(most, ++open);
    return true;
  };
  talk.on_input = [&](virtual_devices::Report& report) {
    // The last piece of an answer: an acknowledgement, a status or a read's end.
    const bool more = report[0] == 0x21 && report[3] == 0xf0 && report[5] == 0x20;
    if (report[0] < 0x30 && !more) --open;
    return true;
  };
  talk.Advance(0.1);
  EXPECT_TRUE(talk.handshake().live());
  EXPECT_EQ(most, 1);
}

TEST(Handshake, WhileDataFlowNothingIsSent) {
  auto talk = WithWiimote();
  talk.Advance(0.1);
  const int modes = talk.Sent(0x12);
  talk.Advance(10);
  EXPECT_EQ(talk.Sent(0x12), modes);
  EXPECT_EQ(talk.Sent(0x15), 1);
}

TEST(Handshake, AnUnaskedStatusBringsTheModeBackWithinAQuarterSecond) {
  auto talk = WithWiimote();
  talk.Advance(0.1);
  talk.Receive(talk.device().controller().UnaskedStatus());
  EXPECT_EQ(talk.device().controller().mode(), 0);
  talk.Advance(0.25);
  EXPECT_EQ(talk.device().controller().mode(), 0x31);
}

TEST(Handshake, AModeThatAnotherProgramSetIsSetBackAtALimitedRate) {
  // The kernel's driver sends 12 00 30 after every status report.
  auto talk = WithWiimote();
  talk.Advance(0.1);
  const int before = talk.Sent(0x12);
  for (int i = 0; i < 40; ++i) {  // Ten seconds of a driver that never gives in.
    talk.device().HandleOutput(virtual_devices::Report{0x12, 0x00, 0x30});
    talk.Advance(0.25);
  }
  EXPECT_GE(talk.Sent(0x12) - before, 5);
  EXPECT_LE(talk.Sent(0x12) - before, 40);
  talk.Advance(3);
  EXPECT_EQ(talk.device().controller().mode(), 0x31);
}

TEST(Handshake, ASilentDeviceIsAskedMoreAndMoreRarelyAndSaysSo) {
  auto talk = WithWiimote();
  talk.Advance(0.1);
  talk.sample = nullptr;
  talk.Advance(20);
  EXPECT_TRUE(talk.handshake().live());
  EXPECT_GE(talk.Sent(0x12), 5);
  // Every 2 s after the first few, and twice after each status asked for at 5, 10 and 15 s.
  EXPECT_LE(talk.Sent(0x12), 1 + 20 / 2 + 5 + 2 * 3);
  EXPECT_GE(talk.Sent(0x15), 1 + 3);
  EXPECT_LE(talk.Sent(0x15), 1 + 4);
  EXPECT_NE(talk.Note(), "");
}

TEST(Handshake, AnExtensionPluggedInChangesTheModeAndKeepsTheCalibration) {
  auto talk = WithWiimote();
  talk.Advance(0.1);
  const int reads = talk.Sent(0x17);
  // The model has no Nunchuk: its id reads fail, as a port that is not ready.
  talk.Receive({0x20, 0, 0, 0x02, 0, 0, 0xc0});
  talk.Advance(5);
  EXPECT_TRUE(talk.handshake().live());
  EXPECT_EQ(talk.status().calibration, CalibrationOrigin::kDevice);
  EXPECT_GT(talk.Sent(0x17), reads);
  talk.Receive({0x20, 0, 0, 0x00, 0, 0, 0xc0});
  talk.Advance(1);
  EXPECT_TRUE(talk.handshake().live());
  EXPECT_EQ(talk.handshake().mode(), 0x31);
}

}  // namespace
}  // namespace footing::handshake
