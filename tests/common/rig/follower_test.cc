#include "common/rig/follower.h"

#include <gtest/gtest.h>

#include "common/stream/user_interface.h"

namespace footing::rig {
namespace {

using stream::DeviceRole;
using stream::DeviceState;
using stream::RoleBit;

constexpr std::uint32_t kHands = RoleBit(DeviceRole::kLeftHand) | RoleBit(DeviceRole::kRightHand);

stream::DeviceStatus DeviceOf(std::uint32_t number, const std::string& rig, DeviceRole role,
                              DeviceState state = DeviceState::kLive) {
  stream::DeviceStatus device;
  device.device = number;
  device.rig = rig;
  device.role = role;
  device.state = state;
  return device;
}

Tick TickWith(std::vector<stream::DeviceStatus> devices, std::uint64_t epoch = 1) {
  Tick tick;
  tick.epoch = epoch;
  tick.devices = std::move(devices);
  return tick;
}

TEST(Follower, FollowsTheFirstRigWithADeviceInOneOfItsRoles) {
  Follower follower("", kHands);
  follower.Take(TickWith({DeviceOf(1, "boards", DeviceRole::kLeftBoard),
                          DeviceOf(2, "main", DeviceRole::kRightHand),
                          DeviceOf(3, "other", DeviceRole::kLeftHand)}));
  EXPECT_EQ(follower.rig(), "main");
  EXPECT_EQ(follower.RoleOf(2), DeviceRole::kRightHand);
  EXPECT_EQ(follower.RoleOf(3), DeviceRole::kUnspecified) << "a device of another rig";
  EXPECT_EQ(follower.RoleOf(9), DeviceRole::kUnspecified) << "a device that is not there";
  ASSERT_NE(follower.Find(3), nullptr);
  EXPECT_EQ(follower.Find(3)->rig, "other");
}

TEST(Follower, StaysOnTheRigThatWasNamed) {
  Follower follower("main", kHands);
  follower.Take(TickWith({DeviceOf(3, "other", DeviceRole::kLeftHand)}));
  EXPECT_EQ(follower.rig(), "main");
  EXPECT_EQ(follower.With(DeviceRole::kLeftHand), nullptr);
  EXPECT_FALSE(follower.Follows("other", DeviceRole::kLeftHand));
}

TEST(Follower, WithoutARigNoDeviceIsFollowedNotEvenOneOfNoRig) {
  Follower follower;
  follower.Take(TickWith({DeviceOf(1, "", DeviceRole::kLeftHand)}));
  EXPECT_EQ(follower.RoleOf(1), DeviceRole::kUnspecified);
  EXPECT_EQ(follower.With(DeviceRole::kLeftHand), nullptr);
  EXPECT_EQ(follower.devices().size(), 1u);
}

TEST(Follower, ASampleMaySpeakForItsRigBeforeTheListOfDevicesDoes) {
  Follower follower("", kHands);
  EXPECT_FALSE(follower.Follows("boards", DeviceRole::kLeftBoard));
  EXPECT_TRUE(follower.Follows("main", DeviceRole::kLeftHand));
  EXPECT_FALSE(follower.Follows("other", DeviceRole::kLeftHand));
}

TEST(Follower, ALostDeviceDoesNotSpeakForItsRig) {
  Follower follower("", kHands);
  Tick tick = TickWith({DeviceOf(1, "old", DeviceRole::kLeftHand, DeviceState::kLost)});
  stream::DeviceFeatures features;
  features.device = 1;
  features.role = DeviceRole::kLeftHand;
  tick.features.emplace_back().rig = "old";
  tick.features[0].devices = {features};
  follower.Take(tick);
  EXPECT_EQ(follower.FeaturesIn(tick), nullptr);
  EXPECT_EQ(follower.rig(), "");
  tick.devices->push_back(DeviceOf(2, "main", DeviceRole::kLeftHand));
  features.device = 2;
  tick.features.emplace_back().rig = "main";
  tick.features[1].devices = {features};
  follower.Take(tick);
  EXPECT_EQ(follower.FeaturesIn(tick), &tick.features[1]);
  tick.devices->back().state = DeviceState::kLost;
  follower.Take(tick);
  EXPECT_EQ(follower.rig(), "main") << "it stays with the rig that it has";
  EXPECT_EQ(follower.FeaturesIn(tick), &tick.features[1]);
}

TEST(Follower, ARestartedServerHasOtherDevicesAndMayHaveAnotherRig) {
  Follower follower("", kHands);
  Tick tick = TickWith({DeviceOf(1, "main", DeviceRole::kLeftHand)});
  tick.setup.emplace(1).front().rig = "main";
  EXPECT_TRUE(follower.Take(tick).restarted);
  EXPECT_FALSE(follower.Take(tick).restarted);
  Tick later;
  later.epoch = 2;
  const Changes changes = follower.Take(later);
  EXPECT_TRUE(changes.restarted);
  EXPECT_FALSE(changes.devices || changes.setup);
  EXPECT_EQ(follower.rig(), "");
  EXPECT_TRUE(follower.devices().empty());
  EXPECT_TRUE(follower.setup().empty());
  follower.Take(TickWith({DeviceOf(1, "other", DeviceRole::kRightHand)}, 2));
  EXPECT_EQ(follower.rig(), "other");
}

TEST(Follower, GoesOverToAnotherRigAndRoles) {
  Follower follower("", kHands);
  const Tick tick = TickWith(
      {DeviceOf(1, "main", DeviceRole::kLeftHand), DeviceOf(2, "boards", DeviceRole::kLeftBoard)});
  follower.Take(tick);
  follower.GoTo("boards", RoleBit(DeviceRole::kLeftBoard));
  follower.Take(tick);
  EXPECT_EQ(follower.rig(), "boards");
  EXPECT_EQ(follower.RoleOf(2), DeviceRole::kLeftBoard);
}

TEST(Follower, OfSeveralDevicesInARoleTheAttachedOneHasIt) {
  Follower follower("main");
  const auto lost = DeviceOf(1, "main", DeviceRole::kLeftBoard, DeviceState::kLost);
  const auto live = DeviceOf(2, "main", DeviceRole::kLeftBoard);
  for (const auto& devices : {std::vector{lost, live}, std::vector{live, lost}}) {
    follower.Take(TickWith(devices));
    EXPECT_EQ(follower.With(DeviceRole::kLeftBoard)->device, 2u);
  }
  follower.Take(TickWith({lost}));
  EXPECT_EQ(follower.With(DeviceRole::kLeftBoard)->device, 1u) << "it keeps its role";
}

TEST(Follower, KnowsWhichRolesAreMounted) {
  Follower follower("main");
  auto leg = DeviceOf(1, "main", DeviceRole::kLeftLeg);
  auto of_other = DeviceOf(2, "other", DeviceRole::kRightLeg);
  leg.mounted = of_other.mounted = true;
  follower.Take(TickWith({leg, of_other, DeviceOf(3, "main", DeviceRole::kTrunk)}));
  EXPECT_TRUE((follower.MountedRoles() & RoleBit(DeviceRole::kLeftLeg)) != 0);
  EXPECT_TRUE((follower.MountedRoles() &
               (RoleBit(DeviceRole::kRightLeg) | RoleBit(DeviceRole::kTrunk))) == 0);
}

TEST(Follower, HasTheLayoutOfItsRigOrTheUsualOne) {
  Follower follower("main");
  Tick tick;
  tick.setup.emplace(2);
  (*tick.setup)[0].rig = "other";
  (*tick.setup)[1].rig = "main";
  (*tick.setup)[1].layout.preset = "custom";
  (*tick.setup)[1].layout.left.x_m = 0.5;
  EXPECT_EQ(follower.Layout().preset, "one_foot_each");
  EXPECT_TRUE(follower.Take(tick).setup);
  EXPECT_EQ(follower.Layout().left.x_m, 0.5);
}

TEST(LastHeard, IsLiveUntilItsTimeoutIsOver) {
  const LastHeard heard{true, 1'000'000'000, false};
  EXPECT_TRUE(heard.IsLive(1'250'000'000, 0.25));
  EXPECT_FALSE(heard.IsLive(1'260'000'000, 0.25));
  EXPECT_FALSE(LastHeard().IsLive(0, 0.25)) << "never heard";
}

}  // namespace
}  // namespace footing::rig
