#include <gtest/gtest.h>

#include "tests/common/guide/person.h"

namespace footing::guide {
namespace {

stream::SetupItem Done(Item item, const std::string& serial, std::int64_t wall_time_ns) {
  stream::SetupItem done = Outcome(item, serial, true, 1, "", "");
  done.wall_time_ns = wall_time_ns;
  return done;
}

TEST(Stale, MountingAfterANewRole) {
  Person person;
  for (auto& device : person.devices) device.mounted = true;
  const std::vector<stream::SetupItem> before{Done(Item::kMounting, "serial-3", 100),
                                              Done(Item::kRoles, "serial-3", 50)};
  EXPECT_FALSE(Merged(before, {}, person.devices)[1].stale);
  const auto after = Merged(before, {Done(Item::kRoles, "serial-3", 200)}, person.devices);
  EXPECT_EQ(after[1].name, "mounting");
  EXPECT_TRUE(after[1].stale);
  EXPECT_NE(after[1].note.find("--only mounting"), std::string::npos);
}

TEST(Stale, LayoutAndTareAfterABoardMoved) {
  Person person;
  person.devices[0].tared = true;
  const std::vector<stream::SetupItem> items{Done(Item::kLayout, "", 100),
                                             Done(Item::kTare, "serial-1", 100)};
  for (const auto& item : Merged(items, {}, person.devices)) EXPECT_FALSE(item.stale);
  person.devices[0].moved = true;
  for (const auto& item : Merged(items, {}, person.devices)) EXPECT_TRUE(item.stale) << item.name;
}

TEST(Stale, AnItemOfADeviceThatIsNotThereAnyMore) {
  Person person;
  const auto items = Merged({Done(Item::kTare, "another", 100)}, {}, person.devices);
  EXPECT_TRUE(items[0].stale);
}

TEST(Stale, ANewResultReplacesAStaleOne) {
  Person person;
  person.devices[0].tared = true;
  stream::SetupItem old = Done(Item::kTare, "serial-1", 100);
  old.stale = true;
  const auto items = Merged({old}, {Done(Item::kTare, "serial-1", 200)}, person.devices);
  ASSERT_EQ(items.size(), 1u);
  EXPECT_FALSE(items[0].stale);
}

}  // namespace
}  // namespace footing::guide
