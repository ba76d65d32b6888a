#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/net/lease.h"

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
    if (field.name() == "marker") continue;                 // It changes recordings only.
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
  v1::Command marker;
  marker.mutable_marker()->set_text("stimulus");
  EXPECT_FALSE(control.Answer(marker, kOther, 1));
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

using testing::IsEmpty;

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::uint64_t kAnna = 7, kBen = 8;

Request Of(std::uint64_t session, const std::string& holder) {
  return {.session = session, .holder = holder};
}

/// The lease of Anna from 0 to 5 s.
Lease OfAnna() {
  Lease lease("footing-sim");
  EXPECT_TRUE(lease.Take(Of(kAnna, "anna"), 0));
  lease.TakeChanges();
  return lease;
}

TEST(Lease, RefusesOthersWithTheNameOfItsHolder) {
  Lease lease("footing-sim");
  EXPECT_TRUE(lease.Check(kBen, 0));  // Nobody has it.
  EXPECT_TRUE(lease.Take(Of(kAnna, "anna"), 0));
  EXPECT_EQ(lease.holder(), "anna");
  EXPECT_TRUE(lease.Check(kAnna, 1));
  EXPECT_THAT(lease.Check(kBen, 1).error().message,
              AllOf(HasSubstr("anna has the lease"), HasSubstr("--take-over")));
  const auto refused = lease.Take(Of(kBen, "ben"), 1);
  EXPECT_EQ(refused.error().kind, ErrorKind::kFailure);
  EXPECT_THAT(refused.error().message, HasSubstr("anna has the lease"));
  EXPECT_THAT(lease.Release(kBen, 1).error().message, HasSubstr("anna has the lease"));
  EXPECT_EQ(lease.holder(), "anna");
  EXPECT_THAT(lease.TakeChanges(), ElementsAre("lease: anna takes it"));
}

TEST(Lease, EndsUnlessItIsRenewed) {
  Lease lease = OfAnna();
  EXPECT_TRUE(lease.Take(Of(kAnna, "anna"), 4 * kSecondNs));  // Until 9 s.
  EXPECT_THAT(lease.TakeChanges(), IsEmpty());
  EXPECT_FALSE(lease.Check(kBen, 9 * kSecondNs - 1));
  EXPECT_TRUE(lease.Check(kBen, 9 * kSecondNs));
  lease.Expire(9 * kSecondNs - 1);
  EXPECT_EQ(lease.holder(), "anna");
  lease.Expire(9 * kSecondNs);
  EXPECT_EQ(lease.holder(), "");
  EXPECT_THAT(lease.TakeChanges(), ElementsAre("lease: that of anna ran out"));
}

TEST(Lease, LastsAsLongAsWasAskedFor) {
  Lease lease("footing-sim");
  Request request = Of(kAnna, "anna");
  request.seconds = 20;
  ASSERT_TRUE(lease.Take(request, 0));
  EXPECT_FALSE(lease.Check(kBen, 20 * kSecondNs - 1));
  EXPECT_TRUE(lease.Check(kBen, 20 * kSecondNs));
}

TEST(Lease, IsTakenOverOnlyOnPurpose) {
  Lease lease = OfAnna();
  Request request = Of(kBen, "ben");
  request.take_over = true;
  ASSERT_TRUE(lease.Take(request, 1));
  EXPECT_THAT(lease.TakeChanges(), ElementsAre("lease: ben takes it over from anna"));
  EXPECT_TRUE(lease.Check(kBen, 2));
  EXPECT_THAT(lease.Check(kAnna, 2).error().message, HasSubstr("ben has the lease"));
}

TEST(Lease, IsNotRenewedOnceItIsLost) {
  Lease lease = OfAnna();
  Request renewal = Of(kAnna, "anna");
  renewal.renew_only = true;
  EXPECT_TRUE(lease.Take(renewal, kSecondNs));
  Request request = Of(kBen, "ben");
  request.take_over = true;
  ASSERT_TRUE(lease.Take(request, 2 * kSecondNs));
  EXPECT_THAT(lease.Take(renewal, 3 * kSecondNs).error().message, HasSubstr("ben has the lease"));
  ASSERT_TRUE(lease.Release(kBen, 3 * kSecondNs));
  EXPECT_THAT(lease.TakeChanges(),
              ElementsAre("lease: ben takes it over from anna", "lease: ben releases it"));
  EXPECT_THAT(lease.Take(renewal, 4 * kSecondNs).error().message, HasSubstr("taken over"));
  EXPECT_EQ(lease.holder(), "");
  renewal.renew_only = false;
  EXPECT_TRUE(lease.Take(renewal, 4 * kSecondNs));
}

TEST(Lease, IsRenewedLateWhileNobodyElseTookIt) {
  Lease lease = OfAnna();
  Request renewal = Of(kAnna, "anna");
  renewal.renew_only = true;
  ASSERT_TRUE(lease.Take(renewal, 6 * kSecondNs));
  EXPECT_THAT(lease.TakeChanges(),
              ElementsAre("lease: that of anna ran out", "lease: anna takes it"));
  EXPECT_FALSE(lease.Check(kBen, 7 * kSecondNs));
  ASSERT_TRUE(lease.Release(kAnna, 7 * kSecondNs));
  EXPECT_FALSE(lease.Take(renewal, 8 * kSecondNs));  // Given back, not late.
  Request request = Of(kBen, "ben");
  ASSERT_TRUE(lease.Take(request, 8 * kSecondNs));
  EXPECT_FALSE(lease.Take(renewal, 20 * kSecondNs));  // Ben was the last one to have it.
}

TEST(Lease, OutlastsItsSessionForAnotherOneOfTheSameName) {
  Lease lease = OfAnna();
  EXPECT_FALSE(lease.Take(Of(9, "anna"), 1));  // Two of one name at a time.
  lease.EndSession(kBen);                      // Not the holder's.
  EXPECT_FALSE(lease.Take(Of(9, "anna"), 1));
  lease.EndSession(kAnna);
  EXPECT_FALSE(lease.Check(kBen, 2));
  EXPECT_FALSE(lease.Take(Of(kBen, "ben"), 2));
  ASSERT_TRUE(lease.Take(Of(9, "anna"), 2));
  EXPECT_THAT(lease.TakeChanges(), IsEmpty());
  EXPECT_TRUE(lease.Check(9, 3));
  EXPECT_FALSE(lease.Check(kAnna, 3));
}

TEST(Lease, RefusesWhatIsNoRequest) {
  Lease lease("footing-sim");
  for (const std::string& holder : {std::string(), std::string(201, 'a'), std::string("a\nb")}) {
    EXPECT_EQ(lease.Take(Of(kAnna, holder), 0).error().kind, ErrorKind::kUsage) << holder;
  }
  EXPECT_TRUE(lease.Take(Of(kAnna, std::string(200, 'a')), 0));
  for (const double seconds : {-1.0, 60.5, std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::quiet_NaN()}) {
    Request request = Of(kAnna, "anna");
    request.seconds = seconds;
    EXPECT_EQ(lease.Take(request, 0).error().kind, ErrorKind::kUsage) << seconds;
  }
  EXPECT_FALSE(Lease("footing-sim").Release(kAnna, 0));
}

}  // namespace
}  // namespace footing::lease
