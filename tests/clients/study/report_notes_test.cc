#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clients/study/report/analysis.h"
#include "clients/study/report/page.h"
#include "tests/clients/study/study_people.h"

namespace footing::study::report {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(StudyAnalysis, CountsCensoredTimesToFailureAndPointsToTheRate) {
  const auto people = People(8);  // With the wrist P0, P3 and P6 do not fail.
  const Analysis analysis = Analyze(Two(), people);
  const auto& between = Find(analysis, "test_mean_time_to_failure_s");
  EXPECT_EQ(between["groups"][0]["censored"], 0);
  EXPECT_EQ(between["groups"][1]["censored"], 3);
  const std::string note = between["note"];
  EXPECT_THAT(note, HasSubstr("Censored trials: joystick 0 of 8, wrist 3 of 8. With few failures "
                              "this measures the time to completion rather than reliability"));
  EXPECT_THAT(note, HasSubstr("believe the rate of failures per minute (negative binomial)"));
  EXPECT_FALSE(Find(analysis, "test_time_to_completion_s").contains("note"));
  EXPECT_FALSE(Find(analysis, "test_time_to_completion_s")["groups"][0].contains("censored"));
  const std::string page = Page(analysis, Two(), people), text = Summary(analysis);
  EXPECT_THAT(page, HasSubstr("<p class=\"believe\">" + note));
  EXPECT_THAT(page, HasSubstr("<th>censored</th>"));
  EXPECT_THAT(page, HasSubstr("<circle class=\"censored\""));
  EXPECT_THAT(page, HasSubstr(", 3 of 8 censored</td>"));
  EXPECT_THAT(text, HasSubstr(note));
  EXPECT_THAT(text, HasSubstr("n 8, censored 3\n"));
  EXPECT_THAT(text, HasSubstr("times the failures per minute ("));
}

TEST(StudyAnalysis, WithoutAFailureThereIsNoRateToBelieve) {
  auto people = People(4);
  for (auto& person : people) {
    for (records::Trial& trial : person.trials) trial.failures.clear();
  }
  const std::string note = Find(Analyze(Two(), people), "test_mean_time_to_failure_s")["note"];
  EXPECT_THAT(note, HasSubstr("nothing here compares reliability"));
}

TEST(StudyAnalysis, PairsRatesRatherThanCounts) {
  // One failure each in every trial, the trials with the wrist being longer for all: equal counts,
  // lower rates, 2 of 2^6 assignments of labels as extreme.
  auto people = People(6);
  for (auto& person : people) {
    person.trials[0].time_s = 100;
    for (records::Trial& trial : person.trials) trial.failures.resize(1, {1, "curve", 1, 1, false});
  }
  const Analysis analysis = Analyze(Two(), people);
  const auto& all = Find(analysis, "test_failures_all");
  EXPECT_EQ(all["test"]["rows"][0]["paired_p"], 1);
  EXPECT_NEAR(all["rate"]["rows"][0]["paired_p"], 2.0 / 64, 1e-12);
}

TEST(StudySummary, EndsEachMeasureWithThePToBelieve) {
  auto people = People(6);
  const std::string text = Summary(Analyze(Two(), people));
  EXPECT_THAT(text, testing::ContainsRegex("rating 1 to 5\n(  .*\n)+  Believe the paired p"));
  EXPECT_THAT(text, HasSubstr("failures of kind jump\n  none at all\n"));
  for (std::size_t i = 0; i < people.size(); ++i) {  // Each participant with one interface.
    people[i].trials.erase(people[i].trials.begin() + static_cast<std::ptrdiff_t>(i % 2));
    people[i].ratings.clear();
  }
  EXPECT_THAT(Summary(Analyze(Two(), people)),
              HasSubstr("Believe p only if every group has other subjects"));
}

TEST(StudySummary, HasNoPOfOneValueInEachGroup) {
  const auto people = People(1);
  const Analysis analysis = Analyze(Two(), people);
  EXPECT_THAT(Summary(analysis), HasSubstr("wrist - joystick: steel p – (too few values)\n"));
  EXPECT_THAT(Summary(analysis), Not(HasSubstr("steel p 1.0000")));
  EXPECT_THAT(Page(analysis, Two(), people), HasSubstr("<td>– (too few values)</td>"));
}

TEST(StudyAnalysis, ComparesNoTimeInMotionThatIsZeroForEverybody) {
  plan::Protocol protocol = Two();
  protocol.interfaces = {"wrist", "leg", "joystick"};
  auto people = People(6);
  for (auto& person : people) {
    person.active_s = {{"wrist", 60}, {"leg", 90}, {"joystick", 0}};
  }
  const auto without_control = Find(Analyze(protocol, people), "active_min");
  EXPECT_EQ(without_control["groups"].size(), 3u);
  EXPECT_FALSE(without_control.contains("test"));
  EXPECT_THAT(std::string(without_control["note"]), HasSubstr("participant: joystick. "));
  protocol.control = "wrist";
  const auto measured = Find(Analyze(protocol, people), "active_min");
  ASSERT_EQ(measured["test"]["rows"].size(), 1u);
  EXPECT_EQ(measured["test"]["rows"][0]["group"], "leg");
  EXPECT_EQ(measured["paired_participants"], 6);
  people[0].active_s["joystick"] = 1;
  EXPECT_EQ(Find(Analyze(protocol, people), "active_min")["test"]["rows"].size(), 2u);
}

}  // namespace
}  // namespace footing::study::report
