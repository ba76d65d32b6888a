// Faults of real devices during the handshake, one line each: every one must end live, with or
// without the device's calibration, and never with nonsense in it.
#include <gtest/gtest.h>

#include <cctype>
#include <random>
#include <string>

#include "common/virtual/devices/controller.h"
#include "common/virtual/devices/wiimote.h"
#include "tests/sensor/reports/fixture.h"

namespace footing::handshake {
namespace {

using stream::CalibrationOrigin;
using virtual_devices::BalanceBoard;
using virtual_devices::Report;
using virtual_devices::Wiimote;

using WiimoteTalk = Conversation<Wiimote>;

void SetEeprom(WiimoteTalk& talk, std::size_t at, std::size_t size, std::uint8_t value) {
  const auto bytes = talk.device().controller().memory().eeprom().subspan(at, size);
  std::fill(bytes.begin(), bytes.end(), value);
}

struct Fault {
  const char* name;
  std::function<void(WiimoteTalk&)> put_in;
  CalibrationOrigin origin;
};

const Fault kFaults[] = {
    {"none", [](WiimoteTalk&) {}, CalibrationOrigin::kDevice},
    {"data before the handshake",
     [](WiimoteTalk& talk) {
       for (int i = 0; i < 50; ++i) talk.Receive({0x31, 0, 0, 0x80, 0x80, 0x9a});
     },
     CalibrationOrigin::kDevice},
    {"a burst of 64 reports",
     [](WiimoteTalk& talk) {
       for (int i = 0; i < 64; ++i) talk.Receive({0x30, 0, 0x08});
     },
     CalibrationOrigin::kDevice},
    {"no acknowledgement ever",
     [](WiimoteTalk& talk) { talk.on_input = [](Report& report) { return report[0] != 0x22; }; },
     CalibrationOrigin::kDevice},
    {"no status ever",
     [](WiimoteTalk& talk) { talk.on_input = [](Report& report) { return report[0] != 0x20; }; },
     CalibrationOrigin::kDevice},
    {"no memory ever",
     [](WiimoteTalk& talk) { talk.on_input = [](Report& report) { return report[0] != 0x21; }; },
     CalibrationOrigin::kDefaults},
    {"the first piece of memory is lost",
     [](WiimoteTalk& talk) {
       talk.on_input = [lost = false](Report& report) mutable {
         const bool first = report[0] == 0x21 && !lost;
         lost = lost || first;
         return !first;
       };
     },
     CalibrationOrigin::kDevice},
    {"every memory reply comes twice",
     [](WiimoteTalk& talk) {
       talk.on_input = [&talk, inside = false](Report& report) mutable {
         if (report[0] == 0x21 && !inside) {
           inside = true;
           talk.Receive(report);
           inside = false;
         }
         return true;
       };
     },
     CalibrationOrigin::kDevice},
    {"replies of the kernel driver's own reads",
     [](WiimoteTalk& talk) {
       talk.on_input = [&talk, inside = false](Report& report) mutable {
         if (report[0] == 0x21 && !inside) {
           inside = true;
           Report other(22, 0xff);
           other[0] = 0x21;
           other[3] = 0x50;
           other[4] = 0x00;
           other[5] = 0xfa;
           talk.Receive(other);
           inside = false;
         }
         return true;
       };
     },
     CalibrationOrigin::kDevice},
    {"memory error 8",
     [](WiimoteTalk& talk) {
       talk.on_input = [](Report& report) {
         if (report[0] == 0x21) report[3] = 0xf8;
         return true;
       };
     },
     CalibrationOrigin::kDefaults},
    {"a short last piece",
     [](WiimoteTalk& talk) {
       talk.on_input = [](Report& report) {
         if (report[0] == 0x21 && report[3] != 0xf0) report.resize(8);
         return true;
       };
     },
     CalibrationOrigin::kDefaults},
    {"acknowledgement with error 2",
     [](WiimoteTalk& talk) {
       talk.on_input = [](Report& report) {
         if (report[0] == 0x22) report[4] = 2;
         return true;
       };
     },
     CalibrationOrigin::kDevice},
    {"block 1 broken", [](WiimoteTalk& talk) { SetEeprom(talk, 0x1f, 1, 0xaa); },
     CalibrationOrigin::kDeviceCopy},
    {"both blocks FF", [](WiimoteTalk& talk) { SetEeprom(talk, 0x16, 20, 0xff); },
     CalibrationOrigin::kDefaults},
    {"both blocks 00", [](WiimoteTalk& talk) { SetEeprom(talk, 0x16, 20, 0x00); },
     CalibrationOrigin::kDefaults},
    {"every output is lost",
     [](WiimoteTalk& talk) { talk.on_output = [](reports::OutputReport&) { return false; }; },
     CalibrationOrigin::kDefaults},
    {"undecodable reports in between",
     [](WiimoteTalk& talk) {
       talk.on_input = [&talk, inside = false](Report&) mutable {
         if (!inside) {
           inside = true;
           talk.Receive({0x00});
           talk.Receive({0x55, 1, 2, 3});
           inside = false;
         }
         return true;
       };
     },
     CalibrationOrigin::kDevice},
};

class HandshakeFault : public testing::TestWithParam<Fault> {};

TEST_P(HandshakeFault, EndLive) {
  WiimoteTalk talk(Wiimote(2), "Nintendo RVL-CNT-01");
  talk.sample = [](Wiimote& wiimote) { return wiimote.Sample({0, 0, -9.81}); };
  GetParam().put_in(talk);
  talk.Advance(6);
  ASSERT_TRUE(talk.handshake().live());
  EXPECT_EQ(talk.status().calibration, GetParam().origin);
  const auto sample =
      calibration::Calibrate(talk.handshake().acceleration(), {0x200, 0x200, 0x268});
  EXPECT_TRUE(sample.specific_force_S_mps2.allFinite());
}

std::string NameOf(const testing::TestParamInfo<Fault>& fault) {
  std::string name = fault.param.name;
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, HandshakeFault, testing::ValuesIn(kFaults), NameOf);

TEST(HandshakeFaults, ABoardThatNeverShowsItsIdentityIsKnownByItsName) {
  Conversation<BalanceBoard> talk(BalanceBoard(2), "Nintendo RVL-WBC-01");
  talk.on_input = [](Report& report) {
    const bool identity = report[0] == 0x21 && report[5] == 0xfa;
    if (identity) std::fill(report.begin() + 6, report.end(), std::uint8_t{0xff});
    return true;
  };
  talk.Advance(5);
  EXPECT_TRUE(talk.handshake().live());
  EXPECT_EQ(talk.kind().kind(), stream::DeviceKind::kBalanceBoard);
  EXPECT_EQ(talk.status().calibration, CalibrationOrigin::kDevice);
}

TEST(HandshakeFaults, AnIdentityThatIsReadyOnlyTheSecondTimeIsUsed) {
  Conversation<BalanceBoard> talk(BalanceBoard(2), "");
  talk.on_input = [first = true](Report& report) mutable {
    if (report[0] == 0x21 && report[5] == 0xfa && first) {
      first = false;
      std::fill(report.begin() + 6, report.end(), std::uint8_t{0xff});
    }
    return true;
  };
  talk.Advance(5);
  EXPECT_TRUE(talk.handshake().live());
  EXPECT_EQ(talk.kind().kind(), stream::DeviceKind::kBalanceBoard);
}

TEST(HandshakeFaults, RandomReportsNeverStopItNorFloodTheDevice) {
  WiimoteTalk talk(Wiimote(2), "Nintendo RVL-CNT-01");
  std::mt19937 random(11);
  int sent = 0;
  talk.on_output = [&sent](reports::OutputReport&) { return ++sent > 0; };
  for (int i = 0; i < 20'000; ++i) {
    Report report(random() % 23);
    for (auto& byte : report) byte = static_cast<std::uint8_t>(random());
    if (!report.empty()) report[0] = static_cast<std::uint8_t>(0x20 + random() % 32);
    talk.Receive(report);
    talk.Advance(0.005);
  }
  talk.sample = [](Wiimote& wiimote) { return wiimote.Sample({0, 0, -9.81}); };
  talk.Advance(10);
  EXPECT_TRUE(talk.handshake().live());
  EXPECT_LT(sent, 10'000);  // 100 s of rubbish: fewer than one report in ten milliseconds.
}

}  // namespace
}  // namespace footing::handshake
