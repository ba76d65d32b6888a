#include "daemon/sensor/service/commands.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sensor/service/kept.h"

namespace footing::sensor {
namespace {

using stream::DeviceRole;
using testing::HasSubstr;
using virtual_devices::Wiimote;

/// A bench with the Wiimote "a", which commands give roles.
struct Commanded {
  explicit Commanded(const setup::Storage& storage = {}) : bench({}, storage) {
    bench.Attach(Wiimote(1), "a");
    bench.Advance(0.1);
  }
  v1::CommandResult Assign(const std::string& rig, int role) {
    v1::Command command;
    command.mutable_assign_role()->set_serial("a");
    command.mutable_assign_role()->set_rig(rig);
    command.mutable_assign_role()->set_role(static_cast<v1::DeviceRole>(role));
    v1::CommandResult result = CarryOut(bench.hub(), lease, {}, 1, command, bench.now_ns());
    bench.Advance(0.1);
    return result;
  }
  std::string Role() const {
    const stream::DeviceStatus& status = bench.StatusOf("a");
    return ToText({status.rig, status.role});
  }

  Bench bench;
  lease::LeaseControl lease{"footingd"};
};

TEST(Commands, AnUnknownRoleIsRefusedAndTheDeviceKeepsItsOwn) {
  Commanded commanded;
  ASSERT_TRUE(commanded.Assign("main", v1::DEVICE_ROLE_HEAD).ok());
  for (const int role : {99, -1}) {
    const v1::CommandResult result = commanded.Assign("main", role);
    EXPECT_FALSE(result.ok());
    EXPECT_THAT(result.message(), HasSubstr("unknown role " + std::to_string(role)));
    EXPECT_THAT(result.message(), HasSubstr("there are left_hand, right_hand"));
  }
  EXPECT_EQ(commanded.Role(), "main/head");
}

TEST(Commands, ARigIsTakenOnlyIfItOutlivesARestart) {
  Kept kept;
  const std::string longest(64, 'r');
  for (const std::string& rig : {longest, std::string("a/b"), std::string("Spieler Ü")}) {
    ASSERT_TRUE(Commanded(kept.storage()).Assign(rig, v1::DEVICE_ROLE_HEAD).ok()) << rig;
    EXPECT_EQ(Commanded(kept.storage()).Role(), rig + "/head");
  }
  for (const std::string& rig : {longest + "r", std::string("a\nb"), std::string("\x1b[2J")}) {
    const v1::CommandResult result = Commanded(kept.storage()).Assign(rig, v1::DEVICE_ROLE_TRUNK);
    EXPECT_FALSE(result.ok()) << rig;
    EXPECT_THAT(result.message(), HasSubstr("must be 1 to 64 bytes"));
  }
  EXPECT_EQ(Commanded(kept.storage()).Role(), "Spieler Ü/head");
}

TEST(Commands, AStoredRoleThatCannotBeReadIsNamedInOneLine) {
  Kept kept;
  kept.storage().save("roles", R"({"a": "\u001b[2J\n/head"})");
  const Commanded commanded(kept.storage());
  EXPECT_EQ(commanded.Role(), "main/left_hand");
  ASSERT_FALSE(commanded.bench.log.empty());
  EXPECT_THAT(commanded.bench.log[0], HasSubstr("the stored role of a is ignored: the rig's name"));
  EXPECT_THAT(commanded.bench.log[0], testing::Not(HasSubstr("\n")));
}

}  // namespace
}  // namespace footing::sensor
