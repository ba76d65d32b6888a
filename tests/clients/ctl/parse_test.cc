#include "clients/ctl/report/parse.h"

#include <gmock/gmock.h>

namespace footing::ctl::doctor {
namespace {

using ::testing::ElementsAre;

TEST(DoctorParse, ReadsBlueZSettingsButNotItsComments) {
  const auto values = ParseIni(
      "# Configuration\n[General]\n#ClassicBondedOnly=true\n ClassicBondedOnly = False \n"
      "UserspaceHID=persist\n");
  EXPECT_EQ(values.size(), 2u);
  EXPECT_EQ(values.at("ClassicBondedOnly"), "false");
  EXPECT_EQ(values.at("UserspaceHID"), "persist");
}

TEST(DoctorParse, KeepsOnlyDevicesLikeOurs) {
  const auto devices = ParseDevices(
      "Device 00:1F:32:AA:BB:CC Nintendo RVL-CNT-01-TR\nDevice 11:22:33:44:55:66 Headset\n"
      "Device not-an-address Nintendo RVL-CNT-01\nDevice 00:06:F7:11:22:33 Motion Controller\n");
  ASSERT_EQ(devices.size(), 2u);
  EXPECT_EQ(devices[0].address, "00:1F:32:AA:BB:CC");
  EXPECT_EQ(devices[0].name, "Nintendo RVL-CNT-01-TR");
  EXPECT_EQ(devices[1].name, "Motion Controller");
}

TEST(DoctorParse, ReadsWhatBluetoothctlSaysOfADevice) {
  KnownDevice device;
  AddInfo("Device X (public)\n\tPaired: yes\n\tBonded: no\n\tTrusted: no\n\tConnected: yes\n",
          device);
  EXPECT_TRUE(device.paired);
  EXPECT_FALSE(device.bonded);
  EXPECT_FALSE(device.trusted);
  EXPECT_TRUE(device.connected);
  AddInfo("\tPaired: yes\n", device);
  EXPECT_TRUE(device.bonded);  // Older ones do not say.
  EXPECT_EQ(ValueOf("bluetoothctl: 5.66\n", "bluetoothctl"), "5.66");
}

TEST(DoctorParse, SeesABlacklistWithEitherSpelling) {
  EXPECT_TRUE(BlacklistsWiimote("blacklist hid-wiimote\n"));
  EXPECT_TRUE(BlacklistsWiimote("\tblacklist\thid_wiimote # no\n"));
  EXPECT_TRUE(BlacklistsWiimote("install hid_wiimote /bin/false\n"));
  EXPECT_FALSE(BlacklistsWiimote("# blacklist hid_wiimote\nblacklist pcspkr\n"));
}

TEST(DoctorParse, SeesThatSpecialDriversAreIgnored) {
  EXPECT_TRUE(IgnoresSpecialDrivers("options hid ignore_special_drivers=1\n"));
  EXPECT_FALSE(IgnoresSpecialDrivers("#options hid ignore_special_drivers=1\n"));
  EXPECT_FALSE(IgnoresSpecialDrivers("options hid ignore_special_drivers=0\n"));
}

TEST(DoctorParse, SeesTheUdevRule) {
  EXPECT_TRUE(HasRule("KERNEL==\"hidraw*\", KERNELS==\"0005:057E:0306.*\", GROUP=\"footing\"\n"));
  EXPECT_TRUE(  // The one that is shipped.
      HasRule("KERNEL==\"hidraw*\", KERNELS==\"0005:057E:*|000[35]:054C:03D5.*|"
              "000[35]:054C:0C5E.*\", GROUP=\"footing\", MODE=\"0660\"\n"));
  EXPECT_FALSE(HasRule("# KERNEL==\"hidraw*\", KERNELS==\"0005:057E:0306.*\"\n"));
  EXPECT_FALSE(HasRule("KERNEL==\"hidraw*\", KERNELS==\"0005:046D:*\"\n"));
}

TEST(DoctorParse, KnowsOurDevicesByTheirSysfsNames) {
  EXPECT_TRUE(IsOurs("0005:057E:0330.0003"));
  EXPECT_TRUE(IsOurs("0003:054C:03D5.0001"));
  EXPECT_TRUE(IsOurs("0005:057E:2007.0001"));
  EXPECT_TRUE(IsOfSwitch("0005:057E:2009.0001"));
  EXPECT_FALSE(IsOurs("0003:057E:2009.0001"));  // On its cable it speaks another protocol.
  EXPECT_FALSE(IsOurs("0005:057E:2069.0001"));
}

TEST(DoctorParse, FindsTheRuleOfJoycond) {
  EXPECT_TRUE(
      TakesSwitchNodes("KERNEL==\"hidraw*\", SUBSYSTEM==\"hidraw\", KERNELS==\"0005:057E:2009.*\", "
                       "MODE=\"0600\"\n"));
  EXPECT_FALSE(TakesSwitchNodes("KERNEL==\"hidraw*\", KERNELS==\"0005:057E:*\", MODE=\"0660\"\n"));
}

TEST(DoctorParse, ReadsWhoRunsAProcess) {
  const User user = ParseProcess(
      "Name:\tfootingd\nUid:\t995\t996\t996\t996\nGid:\t990\t991\t991\t991\nGroups:\t4 24 \n");
  EXPECT_EQ(user.uid, 996u);  // The effective one.
  EXPECT_THAT(user.gids, ElementsAre(991u, 4u, 24u));
}

TEST(DoctorParse, FindsAGroupAndItsMembers) {
  std::uint32_t gid = 0;
  std::vector<std::string> members;
  EXPECT_TRUE(ParseGroup("root:x:0:\nfooting:x:990:ann,bob\n", "footing", gid, members));
  EXPECT_EQ(gid, 990u);
  EXPECT_THAT(members, ElementsAre("ann", "bob"));
  EXPECT_FALSE(ParseGroup("root:x:0:\n", "footing", gid, members));
}

}  // namespace
}  // namespace footing::ctl::doctor
