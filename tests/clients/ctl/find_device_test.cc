#include "clients/ctl/report/device_table.h"

#include <gmock/gmock.h>

namespace footing::ctl::display {
namespace {

using ::testing::HasSubstr;

stream::DeviceStatus Device(std::uint32_t number, const std::string& serial, const std::string& rig,
                            stream::DeviceRole role) {
  stream::DeviceStatus device;
  device.device = number;
  device.serial = serial;
  device.rig = rig;
  device.role = role;
  device.state = stream::DeviceState::kLive;
  return device;
}

std::vector<stream::DeviceStatus> ThreeDevices() {
  return {Device(1, "00:1f:32:aa:bb:cc", "main", stream::DeviceRole::kLeftHand),
          Device(2, "00:1f:32:aa:bb:dd", "main", stream::DeviceRole::kRightHand),
          Device(3, "00:1f:32:aa:bb:ee", "second", stream::DeviceRole::kLeftHand)};
}

TEST(FindDevice, TakesSerialNumberRoleAndRigWithRole) {
  for (const char* name : {"00:1F:32:AA:BB:DD", "2", "right_hand", "main/right_hand"}) {
    const auto found = FindDevice(ThreeDevices(), name);
    ASSERT_TRUE(found.ok()) << name;
    EXPECT_EQ(found->device, 2u) << name;
  }
  EXPECT_EQ(FindDevice(ThreeDevices(), "second/left_hand")->device, 3u);
}

TEST(FindDevice, RefusesARoleThatTwoRigsHave) {
  const auto found = FindDevice(ThreeDevices(), "left_hand");
  ASSERT_FALSE(found.ok());
  EXPECT_EQ(found.error().kind, ErrorKind::kNoDevice);
  EXPECT_THAT(found.error().message, HasSubstr("second/left_hand"));
}

TEST(FindDevice, ListsWhatThereIs) {
  const auto found = FindDevice(ThreeDevices(), "head");
  ASSERT_FALSE(found.ok());
  EXPECT_EQ(found.error().kind, ErrorKind::kNoDevice);
  EXPECT_THAT(found.error().message, HasSubstr("2 = 00:1f:32:aa:bb:dd = main/right_hand"));
}

TEST(FindDevice, LeavesARoleToTheDeviceThatIsThere) {
  auto devices = ThreeDevices();
  devices.push_back(Device(4, "00:1f:32:aa:bb:ff", "main", stream::DeviceRole::kRightHand));
  devices[1].state = stream::DeviceState::kLost;
  EXPECT_EQ(FindDevice(devices, "right_hand")->device, 4u);
  EXPECT_EQ(FindDevice(devices, "2")->serial, "00:1f:32:aa:bb:dd");
}

TEST(ParseRigRole, TakesARoleWithOrWithoutItsRig) {
  EXPECT_EQ(ParseRigRole("main/left_board")->first, "main");
  EXPECT_EQ(ParseRigRole("main/left_board")->second, stream::DeviceRole::kLeftBoard);
  EXPECT_EQ(ParseRigRole("head")->first, "");
  EXPECT_EQ(ParseRigRole("head")->second, stream::DeviceRole::kHead);
}

TEST(ParseRigRole, ListsTheRolesForAnythingElse) {
  for (const char* text : {"", "foot", "main/", "/head", "main/foot"}) {
    const auto parsed = ParseRigRole(text);
    ASSERT_FALSE(parsed.ok()) << text;
    EXPECT_EQ(parsed.error().kind, ErrorKind::kUsage);
    EXPECT_THAT(parsed.error().message, HasSubstr("left_hand, right_hand"));
  }
}

TEST(Boards, AreThoseThatAreThereAndThoseThatAreMissed) {
  std::vector<stream::DeviceStatus> devices = ThreeDevices();
  const auto board = [&](std::uint32_t number, stream::DeviceRole role, stream::DeviceState state) {
    stream::DeviceStatus& one =
        devices.emplace_back(Device(number, "board" + std::to_string(number), "main", role));
    one.kind = stream::DeviceKind::kBalanceBoard;
    one.state = state;
  };
  board(4, stream::DeviceRole::kLeftBoard, stream::DeviceState::kLive);
  board(5, stream::DeviceRole::kRightBoard, stream::DeviceState::kLost);
  board(6, stream::DeviceRole::kLeftBoard, stream::DeviceState::kLost);  // Board 4 replaces it.
  board(7, stream::DeviceRole::kUnspecified, stream::DeviceState::kLost);
  const Boards boards = BoardsOf(devices);
  ASSERT_EQ(boards.there.size(), 1u);
  EXPECT_EQ(boards.there[0].device, 4u);
  ASSERT_EQ(boards.lost.size(), 1u);
  EXPECT_EQ(boards.lost[0].device, 5u);
}

TEST(Reassigned, AreBothDevicesOfASwap) {
  const std::vector<stream::DeviceStatus> before = ThreeDevices();
  std::vector<stream::DeviceStatus> now = before;
  EXPECT_TRUE(Reassigned(before, now).empty());
  std::swap(now[0].role, now[1].role);
  now.push_back(Device(4, "00:1f:32:aa:bb:ff", "main", stream::DeviceRole::kHead));  // New.
  const auto changed = Reassigned(before, now);
  ASSERT_EQ(changed.size(), 2u);
  EXPECT_EQ(changed[0].device, 1u);
  EXPECT_EQ(changed[1].device, 2u);
}

}  // namespace
}  // namespace footing::ctl::display
