#include "clients/ctl/collect.h"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace footing::ctl {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A host in a folder.
class Collect : public ::testing::Test {
 protected:
  Collect() {
    std::string form = (fs::temp_directory_path() / "footing-host.XXXXXX").string();
    root_ = mkdtemp(form.data());
  }
  ~Collect() override { fs::remove_all(root_); }

  void Write(const std::string& path, const std::string& text) {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path, std::ios::binary) << text;
  }

  doctor::Facts Facts() const { return CollectHost(root_.string()); }

  fs::path root_;
};

TEST_F(Collect, FindsADeviceItsDriverAndItsNode) {
  const std::string device = "sys/bus/hid/devices/0005:057E:0306.0002/";
  Write(device + "uevent",
        "DRIVER=wiimote\nHID_ID=0005:0000057E:00000306\nHID_NAME=Nintendo RVL-WBC-01\n"
        "HID_PHYS=aa\nHID_UNIQ=00:22:4c:11:22:33\n");
  Write(device + "hidraw/hidraw3/dev", "241:3\n");
  Write("dev/hidraw3", "");
  chmod((root_ / "dev/hidraw3").c_str(), 0640);
  Write("sys/bus/hid/devices/0003:046D:C31C.0001/uevent", "HID_NAME=Keyboard\n");
  const auto facts = Facts();
  ASSERT_EQ(facts.hid.size(), 1u);
  EXPECT_EQ(facts.hid[0].name, "Nintendo RVL-WBC-01");
  EXPECT_EQ(facts.hid[0].serial, "00:22:4c:11:22:33");
  EXPECT_EQ(facts.hid[0].driver, "wiimote");
  EXPECT_EQ(facts.hid[0].node, "/dev/hidraw3");
  EXPECT_TRUE(facts.hid[0].node_exists);
  EXPECT_EQ(facts.hid[0].node_mode, 0640u);
  EXPECT_EQ(facts.hid[0].node_uid, geteuid());
}

TEST_F(Collect, FindsADeviceWithoutDriverOrNode) {
  Write("sys/bus/hid/devices/0005:057E:0306.0002/uevent", "HID_NAME=Nintendo RVL-CNT-01\n");
  const auto facts = Facts();
  ASSERT_EQ(facts.hid.size(), 1u);
  EXPECT_EQ(facts.hid[0].driver, "");
  EXPECT_EQ(facts.hid[0].node, "");
  EXPECT_FALSE(facts.hid[0].node_exists);
}

TEST_F(Collect, CountsTheLinksOfAnAdapter) {
  Write("sys/class/bluetooth/hci0/rfkill1/soft", "1\n");
  Write("sys/class/bluetooth/hci0/rfkill1/hard", "0\n");
  Write("sys/class/bluetooth/hci0:11/type", "");
  Write("sys/class/bluetooth/hci0:12/type", "");
  const auto facts = Facts();
  ASSERT_EQ(facts.adapters.size(), 1u);
  EXPECT_EQ(facts.adapters[0].name, "hci0");
  EXPECT_EQ(facts.adapters[0].links, 2);
  EXPECT_TRUE(facts.adapters[0].blocked_soft);
  EXPECT_FALSE(facts.adapters[0].blocked_hard);
}

TEST_F(Collect, CountsDaemonsThatTakeRealDevices) {
  const auto run = [&](const std::string& number, const std::string& name,
                       const std::string& words) {
    Write("proc/" + number + "/comm", name + "\n");
    Write("proc/" + number + "/cmdline", words);
    Write("proc/" + number + "/status", "Uid:\t995\t995\t995\t995\nGid:\t990\t990\t990\t990\n");
  };
  run("11", "footingd", std::string("footingd\0", 9));
  run("12", "footingd", std::string("footingd\0--source\0stream:unix:/d\0", 33));
  run("13", "footingd", std::string("footingd\0--source\0hid\0", 22));
  run("14", "bluetoothd", "bluetoothd");
  Write("etc/passwd", "root:x:0:0::/:/bin/sh\nfooting:x:995:990::/:/bin/false\n");
  const auto facts = Facts();
  ASSERT_EQ(facts.daemons.size(), 2u);
  EXPECT_EQ(facts.daemons.count(11), 1u);
  EXPECT_EQ(facts.daemons.count(13), 1u);
  EXPECT_EQ(facts.daemons.at(11).name, "footing");
  EXPECT_TRUE(facts.bluetoothd_running);
}

TEST_F(Collect, ReadsRulesBlacklistsAndSettings) {
  Write("usr/lib/udev/rules.d/70-footing.rules", "KERNEL==\"hidraw*\", KERNELS==\"0005:057E:*\"\n");
  Write("etc/udev/rules.d/10-other.rules", "KERNEL==\"sd*\"\n");
  Write("etc/modprobe.d/wii.conf", "blacklist hid_wiimote\n");
  Write("etc/modprobe.d/wii.conf.bak", "blacklist hid_wiimote\n");
  Write("etc/bluetooth/input.conf", "[General]\nClassicBondedOnly=false\n");
  Write("etc/group", "footing:x:990:nobody-here\n");
  const auto facts = Facts();
  EXPECT_THAT(facts.udev_rules, ElementsAre("/usr/lib/udev/rules.d/70-footing.rules"));
  EXPECT_THAT(facts.others.blacklists, ElementsAre("/etc/modprobe.d/wii.conf"));
  EXPECT_EQ(facts.input_config.at("ClassicBondedOnly"), "false");
  EXPECT_EQ(facts.footing_gid, 990u);
  EXPECT_FALSE(facts.user_listed_in_group);
  EXPECT_FALSE(facts.ignore_special_drivers);
}

TEST_F(Collect, BelievesTheKernelMoreThanAFileOnSpecialDrivers) {
  Write("etc/modprobe.d/footing.conf", "options hid ignore_special_drivers=1\n");
  EXPECT_TRUE(Facts().ignore_special_drivers);
  Write("sys/module/hid/parameters/ignore_special_drivers", "0\n");
  EXPECT_FALSE(Facts().ignore_special_drivers);
}

TEST_F(Collect, FindsNothingOnAnEmptyHost) {
  const auto facts = Facts();
  EXPECT_THAT(facts.hid, IsEmpty());
  EXPECT_THAT(facts.adapters, IsEmpty());
  EXPECT_THAT(facts.udev_rules, IsEmpty());
  EXPECT_FALSE(facts.bluetoothd_running);
}

}  // namespace
}  // namespace footing::ctl
