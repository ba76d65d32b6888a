#include "daemon/simulation/gait_service/lease_control.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace footing::gait_service {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr std::uint64_t kStudy = 3, kOther = 4;

v1::Command Take(const std::string& holder) {
  v1::Command command;
  command.mutable_take_lease()->set_holder(holder);
  return command;
}

TEST(LeaseControl, ForbidsOthersWhatConcernsTrialsAndNothingElse) {
  LeaseControl control;
  v1::Command start, stop, correct, interface, back, push, direct;
  start.mutable_start_trial();
  stop.mutable_stop_trial();
  correct.mutable_correct_failure();
  interface.mutable_set_interface();
  back.mutable_put_back();
  push.mutable_push();
  direct.mutable_direct_gait();
  ASSERT_TRUE(LeaseControl::Takes(Take("anna")));
  EXPECT_FALSE(LeaseControl::Takes(start));
  ASSERT_TRUE(control.OnCommand(Take("anna"), kStudy, 0).ok());
  for (const v1::Command& command : {start, stop, correct, interface, back}) {
    EXPECT_FALSE(control.Refusal(command, kStudy, 1)) << command.ShortDebugString();
    const auto refusal = control.Refusal(command, kOther, 1);
    ASSERT_TRUE(refusal) << command.ShortDebugString();
    EXPECT_FALSE(refusal->ok());
    EXPECT_THAT(refusal->message(), HasSubstr(": anna has the lease"));
  }
  EXPECT_THAT(control.Refusal(back, kOther, 1)->message(), StartsWith("put_back: "));
  EXPECT_FALSE(control.Refusal(push, kOther, 1));
  EXPECT_FALSE(control.Refusal(direct, kOther, 1));
}

TEST(LeaseControl, PublishesWhatHappensToTheLease) {
  LeaseControl control;
  ASSERT_TRUE(control.OnCommand(Take("anna"), kStudy, 0).ok());
  EXPECT_EQ(control.holder(), "anna");
  auto events = control.TakeEvents(1);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind(), v1::Event::KIND_LEASE);
  EXPECT_EQ(events[0].text(), "lease: anna takes it");
  EXPECT_TRUE(control.TakeEvents(2).empty());
  events = control.TakeEvents(5'000'000'000);  // After its 5 s.
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].text(), "lease: that of anna ran out");
  EXPECT_EQ(control.holder(), "");
  v1::Command release;
  release.mutable_release_lease();
  EXPECT_THAT(control.OnCommand(release, kStudy, 6'000'000'000).message(),
              StartsWith("release_lease: nobody has the lease"));
}

}  // namespace
}  // namespace footing::gait_service
