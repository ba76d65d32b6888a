#include "clients/view/scene/study_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clients/view/scene/model.h"
#include "clients/view/scene/words.h"

namespace footing::scene {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

stream::StudyState Trial() {
  return {.study = "Four interfaces",
          .participant = "P07",
          .interface = "wrist",
          .phase = "wrist.straight1",
          .number = 5,
          .phases = 23,
          .doing = "The trial is running.",
          .next = "wrist.straight2",
          .keys = "s stops it",
          .active_s = 750,
          .attempt = 2};
}

TEST(StudyText, SaysWhoWhereWhatAndWhatNext) {
  EXPECT_THAT(StudyLines(Trial(), 0),
              ElementsAre("P07, wrist.straight1, attempt 2 (5 of 23)", "The trial is running.",
                          "next: wrist.straight2; in motion so far 12.5 min", "keys: s stops it"));
}

TEST(StudyText, CountsDownFromWhenItWasSent) {
  stream::StudyState practice = Trial();
  practice.left_s = 125;
  EXPECT_EQ(StudyClock(practice, 0), "2:05");
  EXPECT_EQ(StudyClock(practice, 64.5), "1:01");
  EXPECT_EQ(StudyClock(practice, 500), "0:00");
  EXPECT_EQ(StudyClock(Trial(), 3), "");
}

TEST(StudyText, IsOnTheTextScreenOnlyWhileAStudyRuns) {
  Model model;
  Update update;
  update.received_ns = 5;
  update.study = Trial();
  Apply(model, update);
  EXPECT_EQ(model.study.received_ns, 5);
  EXPECT_THAT(StatusScreen(model, 5), testing::Contains(HasSubstr("P07, wrist.straight1")));
  update.study = stream::StudyState{};
  Apply(model, update);
  EXPECT_THAT(StatusScreen(model, 5), testing::Not(testing::Contains(HasSubstr("P07"))));
}

}  // namespace
}  // namespace footing::scene
