#include "clients/study/plan/protocol.h"

#include <ostream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace footing::study::plan {
namespace {

using testing::HasSubstr;

std::string With(const std::string& more) {
  return R"({"version": 1, "name": "n", "participants": ["P1", "P2"],
             "interfaces": ["wrist", "joystick"], "seed": 3)" +
         more + "}";
}

TEST(Protocol, HasThePapersDefaults) {
  const auto protocol = ParseProtocol(With(""), "a.json");
  ASSERT_TRUE(protocol) << protocol.error().message;
  EXPECT_EQ(protocol->practice_s, 300);      // "practiced the interfaces for five minutes"
  EXPECT_EQ(protocol->straight_trials, 2u);  // "straight track task twice"
  EXPECT_EQ(protocol->test_tracks.size(), 4u);
  EXPECT_EQ(protocol->survey.ratings.size(), 6u);
  EXPECT_EQ(protocol->final_survey.items.ratings.size(), 6u);  // "rank each interface"
  EXPECT_TRUE(protocol->final_survey.each_interface);
  EXPECT_FALSE(protocol->final_survey.items.exertion);
  EXPECT_EQ(protocol->control, "joystick");
  EXPECT_EQ(protocol->order, Order::kWilliams);
  EXPECT_FALSE(protocol->devices.allow_simulated);
}

TEST(Protocol, ReadsItsKeysAndComments) {
  const auto protocol = ParseProtocol(
      With(R"(, "order": "random", "control": "wrist", "practice_s": 20, "test_tracks": ["2"],
              "survey": {"ratings": ["fun"], "exertion": false}, // short
              "devices": {"least_battery": 0.5, "allow_simulated": true})"),
      "a.json");
  ASSERT_TRUE(protocol) << protocol.error().message;
  EXPECT_EQ(protocol->order, Order::kRandom);
  EXPECT_EQ(protocol->control, "wrist");
  EXPECT_EQ(protocol->practice_s, 20);
  EXPECT_EQ(protocol->test_tracks, std::vector<std::string>{"2"});
  EXPECT_EQ(protocol->survey.ratings, std::vector<std::string>{"fun"});
  EXPECT_EQ(protocol->devices.least_battery, 0.5);
  EXPECT_TRUE(protocol->devices.allow_simulated);
}

TEST(Protocol, ItsSurveysTakeThePlaceOfThePapers) {
  const auto protocol = ParseProtocol(With(R"(, "survey": {"questions": ["why"]},
                                              "final_survey": {"ratings": ["like"]})"),
                                      "a.json");
  ASSERT_TRUE(protocol) << protocol.error().message;
  EXPECT_TRUE(protocol->survey.ratings.empty());
  EXPECT_EQ(protocol->survey.questions, std::vector<std::string>{"why"});
  EXPECT_FALSE(protocol->survey.exertion);
  EXPECT_EQ(protocol->final_survey.items.ratings, std::vector<std::string>{"like"});
  EXPECT_TRUE(protocol->final_survey.items.questions.empty());
  EXPECT_TRUE(protocol->final_survey.overall.empty());
  EXPECT_TRUE(protocol->final_survey.each_interface);
}

struct Fault {
  std::string text;
  std::string says;

  friend void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.says; }
};
class FaultyProtocol : public testing::TestWithParam<Fault> {};

TEST_P(FaultyProtocol, IsInvalidDataThatNamesTheKey) {
  const auto protocol = ParseProtocol(GetParam().text, "a.json");
  ASSERT_FALSE(protocol);
  EXPECT_EQ(protocol.error().kind, ErrorKind::kInvalidData);
  EXPECT_THAT(protocol.error().message, HasSubstr("a.json"));
  EXPECT_THAT(protocol.error().message, HasSubstr(GetParam().says));
}

INSTANTIATE_TEST_SUITE_P(
    All, FaultyProtocol,
    testing::Values(
        Fault{"{", "not JSON"}, Fault{"[]", "must be a JSON object"},
        Fault{With(R"(, "practise_s": 3)"), "unknown key \"practise_s\""},
        Fault{With(R"(, "survey": {"rating": []})"), "survey: unknown key \"rating\""},
        Fault{With(R"(, "survey": {"ratings": ["exertion"]})"), "a scale of its own"},
        Fault{With(R"(, "survey": {"ratings": ["fun"], "questions": ["fun"]})"),
              "questions has \"fun\", which is a rating, too"},
        Fault{With(R"(, "final_survey": {"ratings": ["fun"], "each_interface": false,
                                       "overall": ["fun"]})"),
              "overall has \"fun\", which is asked about the whole study already"},
        Fault{With(R"(, "practice_s": -1)"), "practice_s is -1; it must be a number from"},
        Fault{With(R"(, "straight_trials": 1.5)"), "straight_trials is 1.5"},
        Fault{With(R"(, "order": "latin")"), "it must be williams or random"},
        Fault{With(R"(, "control": "leg")"), "not one of interfaces"},
        Fault{With(R"(, "turn_by": "nose")"), "it must be head, trunk or feet"},
        Fault{R"({"version": 1, "name": "n", "participants": ["P1", "P1"],
                  "interfaces": ["wrist"], "seed": 3})",
              "participants has \"P1\" twice"},
        Fault{R"({"version": 1, "name": "n", "participants": ["Lock"],
                  "interfaces": ["wrist"], "seed": 3})",
              "name of the study's lock"},
        Fault{R"({"version": 1, "name": "n", "participants": ["P1", "p1"],
                  "interfaces": ["wrist"], "seed": 3})",
              "differ by more than case"},
        Fault{R"({"version": 1, "name": "n", "participants": ["../x"],
                  "interfaces": ["wrist"], "seed": 3})",
              "a code is 1 to 16"},
        Fault{R"({"version": 1, "name": "n", "participants": ["P1"],
                  "interfaces": ["telepathy"], "seed": 3})",
              "unknown interface \"telepathy\"; there are: wrist, arm"},
        Fault{R"({"version": 1, "name": "n", "participants": ["P1"], "interfaces": ["wrist"]})",
              "seed is missing"},
        Fault{R"({"version": 2, "name": "n", "participants": ["P1"],
                  "interfaces": ["wrist"], "seed": 3})",
              "version is 2"}));

}  // namespace
}  // namespace footing::study::plan
