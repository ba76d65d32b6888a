#include "clients/study/plan/phases.h"

#include <algorithm>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clients/study/plan/protocol.h"

namespace footing::study::plan {
namespace {

Protocol Four() {
  Protocol protocol;
  for (int i = 1; i <= 8; ++i) protocol.participants.push_back("P" + std::to_string(i));
  protocol.interfaces = {"wrist", "arm", "leg", "joystick"};
  protocol.control = "joystick";
  protocol.straight_tasks = {"a", "b", "c", "d", "e", "f"};
  protocol.seed = 11;
  return protocol;
}

TEST(Sessions, FollowThePapersSequence) {
  for (const SessionPlan& session : MakeSessions(Four())) {
    std::vector<std::string> ids;
    for (const Phase& phase : session.phases) ids.push_back(phase.id);
    std::vector<std::string> expected = {"consent", "device_check"};
    for (std::size_t i = 0; i < 4; ++i) {
      const std::string& name = session.interfaces[i];
      if (i > 0) expected.push_back(name + ".rest");
      for (const char* part :
           {"demonstration", "practice", "straight1", "straight2", "test", "survey"}) {
        expected.push_back(name + "." + part);
      }
    }
    expected.push_back("final_survey");
    EXPECT_EQ(ids, expected);
  }
}

TEST(SurveyItems, AtTheEndAskEachItemOfEveryInterface) {
  // "After using all four interfaces, the subjects also completed a survey which required them to
  // rank each interface" by six items, "and to list good and bad aspects of each interface".
  const Protocol protocol = Four();
  const auto items = ItemsAtEnd(protocol, {"leg", "joystick", "wrist", "arm"});
  ASSERT_EQ(items.size(), 6u * 4 + 2 * 4 + 2);
  EXPECT_EQ(items[0], (SurveyItem{"leg", "fun", SurveyScale::kRating, true}));
  EXPECT_EQ(items[3], (SurveyItem{"arm", "fun", SurveyScale::kRating, true}));
  EXPECT_EQ(items[4], (SurveyItem{"leg", "ease of use", SurveyScale::kRating, true}));
  EXPECT_EQ(items[24], (SurveyItem{"leg", "good", SurveyScale::kText, true}));
  EXPECT_EQ(items.back(), (SurveyItem{"", "remarks", SurveyScale::kText, true}));
  const auto after = ItemsAfter(protocol, "leg");
  ASSERT_EQ(after.size(), 6u + 1 + 2);
  EXPECT_EQ(after[6], (SurveyItem{"leg", "exertion", SurveyScale::kExertion, false}));
}

TEST(SurveyItems, LetThePreferredInterfaceBeChosenAmongThoseThatWereUsed) {
  const auto items = ItemsAtEnd(Four(), {"leg", "arm"});
  const SurveyItem& preferred = items[items.size() - 2];
  EXPECT_EQ(preferred,
            (SurveyItem{"", "preferred interface", SurveyScale::kChoice, true, {"leg", "arm"}}));
}

TEST(SurveyItems, AtTheEndAskOnceOfTheWholeStudyWhereTheProtocolSaysSo) {
  Protocol protocol = Four();
  protocol.final_survey.each_interface = false;
  protocol.final_survey.items.questions.clear();
  protocol.final_survey.overall.clear();
  const auto items = ItemsAtEnd(protocol, {"leg", "arm"});
  ASSERT_EQ(items.size(), 6u);
  EXPECT_EQ(items[5], (SurveyItem{"", "like", SurveyScale::kRating, true}));
}

TEST(Sessions, HaveEachTestTrackOncePerParticipant) {
  std::map<std::string, std::set<std::string>> met_with;  // Track to interfaces.
  for (const SessionPlan& session : MakeSessions(Four())) {
    std::set<std::string> tracks;
    for (const Phase& phase : session.phases) {
      if (phase.kind != PhaseKind::kTestTrack) continue;
      tracks.insert(phase.track);
      met_with[phase.track].insert(phase.interface);
    }
    EXPECT_EQ(tracks, (std::set<std::string>{"1", "2", "3", "4"}));
  }
  for (const auto& [track, interfaces] : met_with) EXPECT_GT(interfaces.size(), 1u);
}

TEST(Sessions, RepeatAStraightTaskOnlyWhenAllHadTheirTurn) {
  for (const SessionPlan& session : MakeSessions(Four())) {
    std::vector<std::string> tasks;
    for (const Phase& phase : session.phases) {
      if (phase.kind == PhaseKind::kStraight) tasks.push_back(phase.task);
    }
    ASSERT_EQ(tasks.size(), 8u);
    EXPECT_EQ(std::set<std::string>(tasks.begin(), tasks.begin() + 6).size(), 6u);
    EXPECT_NE(tasks[6], tasks[7]);
  }
}

TEST(Sessions, DependOnTheSeedAlone) {
  const auto tracks = [](std::uint64_t seed) {
    Protocol protocol = Four();
    protocol.seed = seed;
    std::vector<std::string> found;
    for (const SessionPlan& session : MakeSessions(protocol)) {
      for (const Phase& phase : session.phases) {
        found.push_back(phase.id + phase.track + phase.task + std::to_string(phase.seed));
      }
    }
    return found;
  };
  EXPECT_EQ(tracks(5), tracks(5));
  EXPECT_NE(tracks(5), tracks(6));
}

TEST(Sessions, GiveEveryTrialASeedOfItsOwn) {
  std::set<std::uint64_t> seeds;
  std::size_t trials = 0;
  for (const SessionPlan& session : MakeSessions(Four())) {
    for (const Phase& phase : session.phases) {
      if (!phase.is_trial()) continue;
      ++trials;
      seeds.insert(phase.seed);
      EXPECT_LT(phase.seed, 1ull << 53);
    }
  }
  EXPECT_EQ(seeds.size(), trials);
}

TEST(Remarks, SayWhenASquareIsNotComplete) {
  Protocol protocol = Four();
  EXPECT_TRUE(Remarks(protocol).empty());
  protocol.participants.pop_back();
  ASSERT_EQ(Remarks(protocol).size(), 1u);
  EXPECT_THAT(Remarks(protocol).front(), testing::HasSubstr("multiple of 4"));
}

}  // namespace
}  // namespace footing::study::plan
