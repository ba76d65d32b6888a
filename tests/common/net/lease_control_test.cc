#include "common/net/lease_control.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace footing::lease {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr std::uint64_t kStudy = 3, kOther = 4;

v1::Command Take(const std::string& holder) {
  v1::Command command;
  command.mutable_take_lease()->set_holder(holder);
  return command;
}

/// One command of each kind that changes something.
std::vector<v1::Command> Guarded() {
  std::vector<v1::Command> commands;
  const google::protobuf::Descriptor& type = *v1::Command::descriptor();
  const google::protobuf::OneofDescriptor& actions = *type.FindOneofByName("action");
  for (int i = 0; i < actions.field_count(); ++i) {
    const google::protobuf::FieldDescriptor& field = *actions.field(i);
    if (field.name() == "take_lease" || field.name() == "release_lease") continue;
    if (field.name() == "request_device_status") continue;  // It only reads.
    // The transport answers them; ending sessions is an administrator's, whoever has the lease.
    if (field.name() == "list_sessions" || field.name() == "end_sessions") continue;
    v1::Command& command = commands.emplace_back();
    command.GetReflection()->MutableMessage(&command, &field);
  }
  return commands;
}

TEST(LeaseControl, ForbidsOthersEveryCommandThatChangesSomethingAndNamesTheHolder) {
  LeaseControl control("footingd");
  EXPECT_GE(Guarded().size(), 21u);
  for (const v1::Command& command : Guarded()) EXPECT_FALSE(control.Answer(command, kOther, 1));
  ASSERT_TRUE(control.Answer(Take("anna"), kStudy, 0)->ok());
  for (const v1::Command& command : Guarded()) {
    EXPECT_FALSE(control.Answer(command, kStudy, 1)) << command.ShortDebugString();
    const auto refusal = control.Answer(command, kOther, 1);
    ASSERT_TRUE(refusal) << command.ShortDebugString();
    EXPECT_FALSE(refusal->ok());
    EXPECT_THAT(refusal->message(), HasSubstr(": anna has the lease of this footingd"));
    EXPECT_THAT(refusal->message(), HasSubstr("footing-ctl lease --of footingd --take-over"));
  }
  v1::Command back, status;
  back.mutable_put_back();
  status.mutable_request_device_status();
  EXPECT_THAT(control.Answer(back, kOther, 1)->message(), StartsWith("put_back: "));
  EXPECT_FALSE(control.Answer(status, kOther, 1));
}

TEST(LeaseControl, SaysWhatHappensToTheLease) {
  LeaseControl control("footing-sim");
  ASSERT_TRUE(control.Answer(Take("anna"), kStudy, 0)->ok());
  EXPECT_EQ(control.holder(), "anna");
  EXPECT_THAT(control.TakeChanges(1), ElementsAre("lease: anna takes it"));
  EXPECT_THAT(control.TakeChanges(2), ElementsAre());
  EXPECT_THAT(control.TakeChanges(5'000'000'000),  // After its 5 s.
              ElementsAre("lease: that of anna ran out"));
  EXPECT_EQ(control.holder(), "");
  v1::Command release;
  release.mutable_release_lease();
  EXPECT_THAT(control.Answer(release, kStudy, 6'000'000'000)->message(),
              StartsWith("release_lease: nobody has the lease"));
}

}  // namespace
}  // namespace footing::lease
