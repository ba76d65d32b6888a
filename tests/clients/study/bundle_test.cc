#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clients/study/study_tables.h"

namespace footing::study::bundle {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(ParticipantKey, KeepsNumbersAndAddsNewOnesInRandomOrder) {
  const std::vector<std::string> codes = {"A", "B", "C", "D", "E", "F", "G", "H"};
  ParticipantKey key;
  key.Add(codes, 1);
  std::set<std::string> subjects;
  for (const std::string& code : codes) subjects.insert(key.SubjectOf(code));
  EXPECT_EQ(subjects.size(), 8u);
  EXPECT_EQ(*subjects.begin(), "sub-01");
  EXPECT_EQ(*subjects.rbegin(), "sub-08");
  auto read = ParticipantKey::Parse(key.Text(), "k");
  ASSERT_TRUE(read) << read.error().message;
  read->Add({"A", "new"}, 2);
  for (const std::string& code : codes) EXPECT_EQ(read->SubjectOf(code), key.SubjectOf(code));
  EXPECT_EQ(read->SubjectOf("new"), "sub-09");
  ParticipantKey other;
  other.Add(codes, 3);
  EXPECT_NE(other.Text(), key.Text());  // 1 of 40320 orders.
}

TEST(ParticipantKey, NamesTheLineThatIsWrong) {
  for (const char* wrong :
       {"", "code,number\n", "number,code\n1,A\n1,B\n", "number,code\n1,A\n2,A\n",
        "number,code\n0,A\n", "number,code\nx,A\n", "number,code\n1\n"}) {
    const auto key = ParticipantKey::Parse(wrong, "k.csv");
    ASSERT_FALSE(key) << wrong;
    EXPECT_THAT(key.error().message, HasSubstr("k.csv"));
  }
}

std::vector<records::Records> One() {
  records::Records person;
  person.participant = "Anna7";
  person.interfaces = {"leg", "wrist"};
  person.finished = true;
  person.active_s = {{"leg", 30.5}, {"wrist", 20}};
  person.ratings = {{"Anna7", "wrist", "ease of use", 4, false},
                    {"Anna7", "leg", "exertion", 7, false}};
  person.answers = {{"Anna7", "wrist", "good", "I am Anna", false}};
  records::Trial trial;
  trial.participant = "Anna7";
  trial.phase = "wrist.test";
  trial.interface = "wrist";
  trial.outcome = "finished";
  trial.time_s = 61.5;
  trial.anticipation_s = trial.heading_oscillation_rad = kNan;
  trial.failures = {{1, "jump", 9, 1, true}, {2, "curve", 12.5, 1, false}};
  person.trials = {trial};
  return {person};
}

TEST(StudyTables, HaveNumbersInPlaceOfCodesAndNoTextUnlessAsked) {
  const auto people = One();
  ParticipantKey key;
  key.Add({"Anna7"}, 1);
  const auto participants = ParticipantsTable(people, key);
  EXPECT_EQ(participants.tsv,
            "participant_id\tinterface_order\tfinished\tsynthetic\ttime_in_motion\n"
            "sub-01\tleg wrist\tyes\tno\t50.5\n");
  const auto survey = SurveyTable(people, key, /*with_text=*/false);
  EXPECT_EQ(survey.tsv, "participant_id\tleg_exertion\twrist_ease_of_use\nsub-01\t7\t4\n");
  EXPECT_THAT(survey.codebook["wrist_ease_of_use"]["Description"].get<std::string>(),
              HasSubstr("1 (very little) to 5"));
  EXPECT_THAT(SurveyTable(people, key, /*with_text=*/true).tsv, HasSubstr("I am Anna"));
  const auto trials = TrialsTable(people, key, {{&people[0].trials[0], "stem"}});
  for (const std::string& text : {participants.tsv, survey.tsv, trials.tsv}) {
    EXPECT_THAT(text, Not(HasSubstr("Anna")));
  }
}

TEST(StudyTables, HaveTheFinalSurveyOfEachInterface) {
  auto people = One();
  people[0].ratings = {{"Anna7", "wrist", "fun", 2, false, false},
                       {"Anna7", "wrist", "fun", 5, false, true},
                       {"Anna7", "", "fun", 3, false, true}};
  ParticipantKey key;
  key.Add({"Anna7"}, 1);
  const auto survey = SurveyTable(people, key, /*with_text=*/false);
  EXPECT_EQ(survey.tsv, "participant_id\tfinal_fun\tfinal_wrist_fun\twrist_fun\nsub-01\t3\t5\t2\n");
  EXPECT_THAT(survey.codebook["final_wrist_fun"]["Description"].get<std::string>(),
              HasSubstr("asked at the end about the interface wrist"));
}

TEST(StudyTables, KeepSimilarItemsApart) {
  auto people = One();
  people[0].ratings = {{"Anna7", "wrist", "Spaß", 1, false},
                       {"Anna7", "wrist", "Spaé", 2, false},
                       {"Anna7", "wrist", "a b", 3, false},
                       {"Anna7", "wrist", "a-b", 4, false}};
  people[0].answers.clear();
  ParticipantKey key;
  key.Add({"Anna7"}, 1);
  const auto survey = SurveyTable(people, key, /*with_text=*/false);
  EXPECT_EQ(survey.tsv,
            "participant_id\twrist_Spa__\twrist_Spa___2\twrist_a_b\twrist_a_b_2\n"
            "sub-01\t1\t2\t3\t4\n");
  EXPECT_THAT(survey.codebook["wrist_Spa___2"]["Description"].get<std::string>(),
              HasSubstr("Spaé"));
}

TEST(StudyTables, DescribeEveryColumnOfTrials) {
  const auto people = One();
  ParticipantKey key;
  key.Add({"Anna7"}, 1);
  const auto trials = TrialsTable(people, key, {{&people[0].trials[0], "stem"}});
  const std::string header = trials.tsv.substr(0, trials.tsv.find('\n'));
  EXPECT_EQ(static_cast<std::size_t>(std::count(header.begin(), header.end(), '\t')),
            trials.codebook.size());
  // A column with a unit says so in its name and in the codebook, as BIDS has it.
  for (const auto& [name, meaning] : trials.codebook.items()) {
    const std::string unit = meaning.value("Units", "");
    EXPECT_TRUE(unit.empty() || name.ends_with("_" + unit)) << name;
  }
  EXPECT_THAT(header, HasSubstr("\ttime_s\tdistance_m\ttime_to_first_failure_s\t"
                                "heading_oscillation_rad\tanticipation_s\t"));
  // The first failure was undone: the one at 12.5 s is the first that counts.
  EXPECT_THAT(trials.tsv, HasSubstr("finished\tyes\t61.500\t0.000\t12.500\tn/a\tn/a\tstem\t"));
  EXPECT_THAT(trials.tsv, testing::EndsWith("\t0\t1\t0\t0\t0\n"));  // Five kinds: a curve.
}

}  // namespace
}  // namespace footing::study::bundle
