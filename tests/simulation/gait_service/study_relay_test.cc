#include "daemon/simulation/gait_service/study_relay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "common/net/lease_control.h"

namespace footing::gait_service {
namespace {

using testing::HasSubstr;

const transport::SessionInfo kStudyClient{1, "footing-study", v1::ROLE_CONTROL};
const transport::SessionInfo kOtherClient{2, "other", v1::ROLE_CONTROL};

v1::SetStudy State(const std::string& participant) {
  v1::SetStudy message;
  message.mutable_study()->set_participant(participant);
  return message;
}

TEST(StudyRelay, HandsTheStateOnOnceAndForgetsItWithItsSession) {
  StudyRelay relay;
  EXPECT_FALSE(relay.TakeChange());
  ASSERT_TRUE(relay.OnSetStudy(kStudyClient, State("P01")).ok());
  EXPECT_EQ(relay.TakeChange()->participant, "P01");
  EXPECT_FALSE(relay.TakeChange());
  relay.OnSessionEnd(kOtherClient);
  EXPECT_FALSE(relay.TakeChange());
  relay.OnSessionEnd(kStudyClient);
  EXPECT_EQ(relay.TakeChange()->participant, "");
}

TEST(StudyRelay, RefusesWhatNoScreenCanShow) {
  StudyRelay relay;
  EXPECT_THAT(relay.OnSetStudy(kStudyClient, State(std::string(500, 'x'))).message(),
              HasSubstr("more than 400 bytes"));
  v1::SetStudy message = State("P01");
  message.mutable_study()->set_active_s(std::numeric_limits<double>::infinity());
  ASSERT_TRUE(relay.OnSetStudy(kStudyClient, message).ok());
  EXPECT_EQ(relay.TakeChange()->active_s, 0);  // As the protocol reads what is not finite.
}

TEST(StudyRelay, IsForTheHolderOfTheLease) {
  lease::LeaseControl lease("footing-sim");
  v1::Command take;
  take.mutable_take_lease()->set_holder("ann");
  ASSERT_TRUE(lease.Answer(take, kStudyClient.session, 0)->ok());
  v1::Command command;
  *command.mutable_set_study() = State("P01");
  EXPECT_FALSE(lease.Answer(command, kStudyClient.session, 1));
  ASSERT_TRUE(lease.Answer(command, kOtherClient.session, 1));
  EXPECT_THAT(lease.Answer(command, kOtherClient.session, 1)->message(),
              HasSubstr("set_study: ann"));
}

}  // namespace
}  // namespace footing::gait_service
