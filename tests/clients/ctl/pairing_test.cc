#include "clients/ctl/report/pairing.h"

#include <gmock/gmock.h>

namespace footing::ctl::pairing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const Host kReady = {"hci0", "5.66", false};

TEST(Pairing, KnowsItsKinds) {
  EXPECT_EQ(KindNamed("board"), Kind::kBoard);
  EXPECT_EQ(KindNamed("gamepad"), std::nullopt);
  for (const Kind kind : {Kind::kWiimote, Kind::kBoard, Kind::kMove, Kind::kJoycon}) {
    EXPECT_EQ(KindNamed(Name(kind)), kind);
  }
}

TEST(Pairing, ConnectsDirectlyAfterPairingANintendo) {
  for (const Kind kind : {Kind::kWiimote, Kind::kBoard}) {
    const std::string text = ToText(kind, kReady);
    const std::size_t scan = text.find("scan on"), red = text.find("red button"),
                      pair = text.find("     pair ADDRESS"),
                      connect = text.find("     connect ADDRESS"),
                      trust = text.find("     trust ADDRESS");
    EXPECT_LT(scan, red);
    EXPECT_LT(red, pair);
    EXPECT_LT(pair, connect);
    EXPECT_LT(connect, trust);
    EXPECT_NE(trust, std::string::npos);
  }
}

TEST(Pairing, NamesEachDeviceAsBluetoothctlDoes) {
  EXPECT_THAT(ToText(Kind::kWiimote, kReady), HasSubstr("Nintendo RVL-CNT-01"));
  EXPECT_THAT(ToText(Kind::kBoard, kReady), HasSubstr("Nintendo RVL-WBC-01"));
}

TEST(Pairing, PutsTheCableBeforeTheRadioForAMove) {
  const std::string text = ToText(Kind::kMove, kReady);
  EXPECT_LT(text.find("USB cable"), text.find("PS button"));
  EXPECT_THAT(text, Not(HasSubstr("     pair ADDRESS")));
}

TEST(Pairing, SaysFirstWhatTheHostLacks) {
  EXPECT_THAT(Steps(Kind::kWiimote, {}).front().run, HasSubstr("apt install bluez"));
  EXPECT_THAT(Steps(Kind::kWiimote, {"", "5.66", false}).front().say,
              HasSubstr("no Bluetooth adapter"));
  EXPECT_THAT(Steps(Kind::kWiimote, {"hci0", "5.79", true}).front().say, HasSubstr("5.79"));
  EXPECT_EQ(Steps(Kind::kWiimote, kReady).front().run, "bluetoothctl");
}

TEST(Pairing, EndsInFootingdForEveryKind) {
  for (const Kind kind : {Kind::kWiimote, Kind::kBoard, Kind::kMove, Kind::kJoycon}) {
    const auto out = ToJson(kind, kReady);
    EXPECT_EQ(out["adapter"], "hci0");
    EXPECT_EQ(out["steps"].back()["run"], "footing-ctl devices");
    EXPECT_EQ(out["steps"].size(), Steps(kind, kReady).size());
  }
}

}  // namespace
}  // namespace footing::ctl::pairing
