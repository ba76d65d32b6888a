#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clients/study/report/analysis.h"
#include "clients/study/report/page.h"
#include "common/stream/response.h"
#include "tests/clients/study/study_people.h"

namespace footing::study::report {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(StudyAnalysis, ComparesEachMeasureWithTheControl) {
  const Analysis analysis = Analyze(Two(), People(8));
  const auto& completion = Find(analysis, "test_time_to_completion_s");
  ASSERT_TRUE(completion.is_object());
  EXPECT_EQ(completion["groups"][0]["interface"], "joystick");
  EXPECT_EQ(completion["groups"][0]["mean"], 63.5);    // 60 to 67.
  EXPECT_EQ(completion["groups"][1]["median"], 53.5);  // 50 to 57.
  EXPECT_EQ(completion["test"]["test"], "steel");
  EXPECT_LT(completion["test"]["rows"][0]["p"], 0.01);
  // All eight differences have one sign: 2 of 2^8 assignments of labels are as extreme.
  EXPECT_NEAR(completion["paired"]["rows"][0]["p"], 2.0 / 256, 1e-12);
  // 63.5 s on average, over 2 + 0, 1 or 2 failures.
  const auto& between = Find(analysis, "test_mean_time_to_failure_s");
  EXPECT_NEAR(between["groups"][0]["greatest"], 66.0 / 2, 1e-12);
  EXPECT_TRUE(Find(analysis, "rating fun").is_object());
}

TEST(StudyAnalysis, LeavesOutWhoHasWithdrawnAndPairsOnlyWhatIsComplete) {
  auto people = People(4);
  people[0].withdrawn = true;
  people[1].trials[1].outcome = "timed_out";
  const Analysis analysis = Analyze(Two(), people);
  EXPECT_EQ(analysis.json["withdrawn"], 1);
  const auto& completion = Find(analysis, "test_time_to_completion_s");
  EXPECT_EQ(completion["groups"][0]["n"], 2);  // P2 and P3; P1 did not arrive.
  EXPECT_EQ(completion["groups"][1]["n"], 3);
  EXPECT_EQ(completion["participants"], 3);
  EXPECT_EQ(completion["paired_participants"], 2);
  EXPECT_TRUE(completion.contains("paired"));
  EXPECT_THAT(Page(analysis, Two(), people),
              HasSubstr("Within participants: 2 of 3 participants, those with a value"));
  EXPECT_THAT(ValuesCsv(analysis), Not(HasSubstr("P0")));
  EXPECT_THAT(ValuesCsv(analysis), HasSubstr("test_time_to_completion_s,point,P2,joystick,62\n"));
}

TEST(StudyPage, IsSelfContainedAndMarksSyntheticData) {
  auto people = People(4);
  EXPECT_THAT(Page(Analyze(Two(), people), Two(), people), Not(HasSubstr("Synthetic:")));
  people[2].synthetic = true;
  people[2].answers = {{"P2", "wrist", "good", "<script>x</script>", true}};
  const std::string page = Page(Analyze(Two(), people), Two(), people);
  EXPECT_THAT(page, HasSubstr("Synthetic:"));
  EXPECT_THAT(page, HasSubstr("&lt;script&gt;x"));
  for (const char* outside : {"http:", "https:", "<script", "src=", "url(", "a <b> study"}) {
    EXPECT_THAT(page, Not(HasSubstr(outside)));
  }
}

TEST(Figure, HasAPointForEachValueABoxForEachInterfaceAndALineForEachPerson) {
  const Analysis analysis = Analyze(Two(), People(5));
  const std::string svg = Figure(analysis.measures.front(), Two());
  const auto count = [&](const std::string& what) {
    std::size_t found = 0;
    for (std::size_t at = svg.find(what); at != std::string::npos; at = svg.find(what, at + 1)) {
      ++found;
    }
    return found;
  };
  EXPECT_EQ(count("<circle"), 10u);
  EXPECT_EQ(count("<rect"), 2u);
  EXPECT_EQ(count("class=\"pair\""), 5u);
}

TEST(StudyAnalysis, HasTheRateOfAllFailuresAndSkipsWhatNeverHappened) {
  const auto people = People(6);
  const Analysis analysis = Analyze(Two(), people);
  const auto& all = Find(analysis, "test_failures_all");
  ASSERT_TRUE(all.contains("rate")) << all.dump();
  // 18 failures in 375 s against 6 in 315 s, a minute each: (6 / 315) / (18 / 375).
  EXPECT_NEAR(all["rate"]["rows"][0]["poisson"]["estimate"].get<double>(),
              (6.0 / 315) / (18.0 / 375), 1e-9);
  EXPECT_FALSE(Find(analysis, "test_failures_curve").contains("rate"));
  const std::string page = Page(analysis, Two(), people);
  EXPECT_THAT(page, HasSubstr("None at all: Test track, failures of kind simulation; Test track, "
                              "failures of kind jump"));
  EXPECT_THAT(page, HasSubstr("ratio of rates"));
}

TEST(StudyAnalysis, HasNoCountWithoutItsTimeOrAPlannedTrial) {
  plan::Protocol protocol = Two();
  protocol.straight_trials = 2;
  auto people = People(6);
  for (records::Records& person : people) {
    for (const char* interface : {"wrist", "joystick"}) {
      for (const char* number : {"1", "2"}) {
        records::Trial trial = report::Test(person.participant, interface, 10, 1);
        trial.phase = std::string(interface) + ".straight" + number;
        trial.kind = "straight";
        person.trials.push_back(trial);
      }
    }
  }
  people[0].trials.pop_back();     // One of two straight trials with the joystick.
  people[1].trials[0].time_s = 0;  // Never over the start line with the wrist.
  people[1].trials[0].outcome = "stopped";
  const Analysis analysis = Analyze(protocol, people);
  const auto& straight = Find(analysis, "straight_failures_all");
  EXPECT_EQ(straight["groups"][0]["n"], 5);
  EXPECT_EQ(straight["groups"][0]["least"], 2);
  const auto& test = Find(analysis, "test_failures_all");
  EXPECT_EQ(test["groups"][1]["n"], 5);
  // The exposures are the minutes of the trials: wrist 50, 52 to 55 s with 0, 2, 0, 1, 2 failures.
  EXPECT_NEAR(test["rate"]["rows"][0]["poisson"]["estimate"].get<double>(),
              (5.0 / 264) / (18.0 / 375), 1e-9);
  EXPECT_EQ(Find(analysis, "test_mean_time_to_failure_s")["groups"][1]["n"], 5);
}

TEST(StudyPage, MarksAPOfIndependentGroupsInTheOverview) {
  const auto overview = [](const std::vector<records::Records>& people) {
    const std::string page = Page(Analyze(Two(), people), Two(), people);
    return page.substr(0, page.find("<h2>Completion"));
  };
  auto people = People(16);
  EXPECT_THAT(overview(people), Not(HasSubstr("independent)")));
  EXPECT_THAT(overview(people), HasSubstr("(p\u00a0"));
  people[0].trials.erase(people[0].trials.begin());  // One value is missing: still paired.
  EXPECT_THAT(overview(people), Not(HasSubstr("independent)")));
  for (std::size_t i = 0; i < people.size(); ++i) {  // Each participant with one interface.
    if (people[i].trials.size() > 1) people[i].trials.erase(people[i].trials.begin() + i % 2);
  }
  EXPECT_THAT(overview(people), HasSubstr(", independent)"));
}

TEST(StudyPage, SaysWhichTestToBelieveBesideEachMeasure) {
  const auto people = People(6);
  const Analysis analysis = Analyze(Two(), people);
  const std::string page = Page(analysis, Two(), people);
  const std::string note = Find(analysis, "rating fun")["test"]["note"];
  ASSERT_THAT(note, HasSubstr("Believe the paired p"));
  EXPECT_THAT(page, HasSubstr("<p class=\"believe\">" + Escaped(note)));
}

TEST(StudyPage, ShowsTheTestsWithinParticipantsWithEffectSizes) {
  const auto people = People(8);
  const std::string page = Page(Analyze(Two(), people), Two(), people);
  // Eight differences of -10 s: 2 of 2^8 signs are as extreme for the permutation and for
  // Wilcoxon's test, whatever the ranks; no variance is left to the blocked Dunnett test.
  EXPECT_THAT(page, HasSubstr("<td>wrist - joystick</td><td>0.0078</td><td>0.0078</td>"
                              "<td>&lt;0.0001</td><td>-10 (-10 to -10)</td>"
                              "<td>-10 (-10 to -10)</td><td>-1 ("));
  // Friedman: 12 n / (k (k + 1)) sum (mean rank - 1.5)^2 = 16 (0.25 + 0.25); P(chi2_1 > 8).
  EXPECT_THAT(page, HasSubstr("chi-square 8, degrees of freedom 1, p 0.0047, by permutation "
                              "0.0078."));
  EXPECT_THAT(page, HasSubstr("for every interface; all subjects show the same differences, so "
                              "the blocked Dunnett test has no error"));
}

TEST(StudyPage, HasEffectSizesOfIndependentGroups) {
  auto people = People(8);
  for (std::size_t i = 0; i < people.size(); ++i) {  // Each participant with one interface.
    people[i].trials.erase(people[i].trials.begin() + static_cast<std::ptrdiff_t>(i % 2));
    people[i].ratings.clear();
  }
  const std::string page = Page(Analyze(Two(), people), Two(), people);
  EXPECT_THAT(page, Not(HasSubstr("Within participants")));
  EXPECT_THAT(page, HasSubstr("<th>Hodges-Lehmann (95 %)</th><th>Cliff's delta (95 %)</th>"));
}

TEST(StudyAnalysis, TestsAsItIsAsked) {
  const auto people = People(8);
  TestOptions options;
  options.alternative = statistics::Alternative::kGreater;
  options.ties = statistics::Ties::kJoint;
  options.method = statistics::Method::kAsymptotic;
  options.seed = 77;
  const Analysis analysis = Analyze(Two(), people, options);
  EXPECT_EQ(analysis.json["tests"].dump(),
            R"({"alternative":"greater","ties":"joint","method":"asymptotic","seed":77})");
  const auto& completion = Find(analysis, "test_time_to_completion_s");
  EXPECT_EQ(completion["test"]["method"], "asymptotic");
  EXPECT_EQ(completion["test"]["ties"], "joint");
  EXPECT_GT(completion["test"]["rows"][0]["p"], 0.99);  // The wrist is the faster one.
  EXPECT_EQ(completion["paired"]["rows"][0]["p"], 1);   // All of 2^8 signs are at least as great.
  EXPECT_THAT(Page(analysis, Two(), people), HasSubstr("values greater than the control"));
  EXPECT_EQ(Analyze(Two(), people).json["tests"]["seed"], Two().seed);
  options.method = statistics::Method::kPermutation;
  EXPECT_EQ(Find(Analyze(Two(), people, options), "test_time_to_completion_s")["test"]["seed"], 77);
}

TEST(StudyPage, RoundsEachPForAReader) {
  const auto people = People(8);
  const std::string page = Page(Analyze(Two(), people), Two(), people);
  EXPECT_THAT(page, HasSubstr("<th>Steel, independent groups</th>"));
  EXPECT_THAT(page, HasSubstr("<td>0.0078</td>"));  // 2 / 256, of the paired test.
  EXPECT_THAT(page, HasSubstr("(p\u00a00.0078)"));
  EXPECT_THAT(page, Not(testing::ContainsRegex("[0-9]e-0")));
}

TEST(Latency, IsByStageAndWithoutTheWaitForContact) {
  auto people = People(1);
  for (int i = 1; i <= 100; ++i) {
    people[0].trials[0].responses.push_back(
        {{"decode", 1}, {"command", 4}, {"contact", i <= 40 ? 100.0 : 0.0}, {"frame", 1.0 * i}});
  }
  const Analysis analysis = Analyze(Two(), people);
  ASSERT_EQ(analysis.latency.size(), 7u);
  EXPECT_EQ(analysis.latency[3].stage, "frame");
  EXPECT_EQ(analysis.latency[3].responses, 100u);
  EXPECT_DOUBLE_EQ(analysis.latency[3].p95_ms, 1 + 0.95 * 99);  // For 1 to 100.
  EXPECT_EQ(analysis.latency[4].stage, kWithoutContact);
  EXPECT_EQ(analysis.latency[4].p50_ms, 55.5);  // 50.5, the decoding and the command.
  EXPECT_EQ(analysis.latency[5].stage, kWithoutWindow);
  EXPECT_EQ(analysis.latency[5].p50_ms, 51.5);
  EXPECT_DOUBLE_EQ(analysis.latency[5].p95_ms, 2 + 0.95 * 99);
  EXPECT_EQ(analysis.latency[6].stage, kWhole);
  EXPECT_EQ(analysis.latency[6].p50_ms, 95.5);  // 60 from 46 to 105, then 40 from 106.
  const auto& measure = Find(analysis, "latency_without_contact_ms");
  EXPECT_EQ(measure["groups"][0]["interface"], "wrist");
  EXPECT_THAT(ValuesCsv(analysis), HasSubstr("latency_contact_ms,bar,,wrist,0\n"));
  EXPECT_THAT(ValuesCsv(analysis), HasSubstr("latency_whole_ms,label,,wrist,95.5\n"));
  EXPECT_THAT(Page(analysis, Two(), people), HasSubstr("frame 50.5 ms"));
  EXPECT_THAT(Page(analysis, Two(), people),  // In real time, too.
              HasSubstr("<td>without contact and feature window</td><td>51.5 / 96.0</td>"));
  EXPECT_THAT(Page(analysis, Two(), people), Not(HasSubstr("Time was simulated")));
  people[0].simulated_time = true;
  EXPECT_THAT(Page(Analyze(Two(), people), Two(), people), HasSubstr("Time was simulated"));
}

TEST(Latency, LeavesOutTheStagesThatResponsesName) {
  stream::ResponseStages stamps;
  stamps.report_received_ns = 1'000'000;
  stamps.decoded_ns = stamps.report_received_ns + 1'000'000;
  stamps.features_computed_ns = stamps.decoded_ns + 2'000'000;
  stamps.features_received_ns = stamps.features_computed_ns + 4'000'000;
  stamps.command_ns = stamps.features_received_ns + 8'000'000;
  stamps.contact_ns = stamps.command_ns + 16'000'000;
  stamps.first_frame_ns = stamps.contact_ns + 32'000'000;
  records::Response response;
  for (const auto& one : stream::ResponseTimes(stamps)) response.push_back({one.name, one.ms});
  EXPECT_NEAR(WithoutContactMs(response), 1 + 2 + 4 + 8 + 32, 1e-9);
  EXPECT_NEAR(WithoutWindowMs(response), 1 + 2 + 4 + 32, 1e-9);
}

TEST(StudyAnalysis, ComparesTheRatingsAtTheEnd) {
  auto people = People(6);
  for (records::Records& person : people) {
    person.ratings.push_back({person.participant, "wrist", "fun", 1, false, true});
    person.ratings.push_back({person.participant, "joystick", "fun", 5, false, true});
    person.ratings.push_back({person.participant, "", "worth it", 3, false, true});
    person.answers.push_back({person.participant, "wrist", "good", "light", false, true});
  }
  const Analysis analysis = Analyze(Two(), people);
  const auto& at_end = Find(analysis, "final_rating fun");
  ASSERT_TRUE(at_end.is_object());
  EXPECT_EQ(at_end["groups"][0]["mean"], 5);
  EXPECT_EQ(Find(analysis, "rating fun")["groups"][0]["mean"], 2);  // Right after it.
  const std::string page = Page(analysis, Two(), people);
  EXPECT_THAT(page, HasSubstr("fun, at the end, rating 1 to 5"));
  EXPECT_THAT(page, HasSubstr("<td>worth it, rating 1 to 5</td><td>6</td><td>3</td>"));
  EXPECT_THAT(page, HasSubstr("<td>good, at the end</td><td>light</td>"));
  EXPECT_THAT(ValuesCsv(analysis), HasSubstr("final_rating fun,point,P0,wrist,1\n"));
}

TEST(ValuesCsv, HasTheBoxOfEachInterface) {
  // Quartiles of 60 to 64 s.
  const std::string csv = ValuesCsv(Analyze(Two(), People(5)));
  EXPECT_THAT(csv, HasSubstr("test_time_to_completion_s,lower_quartile,,joystick,61\n"
                             "test_time_to_completion_s,median,,joystick,62\n"
                             "test_time_to_completion_s,upper_quartile,,joystick,63\n"));
}

TEST(Ticks, EncloseTheValuesInFewRoundSteps) {
  for (const double greatest : {1e-3, 0.7, 1.0, 5.0, 63.0, 12345.0}) {
    const auto ticks = Ticks(0, greatest);
    EXPECT_EQ(ticks.front(), 0);
    EXPECT_GE(ticks.back(), greatest * (1 - 1e-12));
    EXPECT_LE(ticks.size(), 8u);
    EXPECT_GE(ticks.size(), 2u);
  }
  EXPECT_EQ(Ticks(0, 5), (std::vector<double>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(Ticks(0, 0).size(), 2u);
  EXPECT_EQ(Ticks(0, 2, /*counts=*/true), (std::vector<double>{0, 1, 2}));
}

}  // namespace
}  // namespace footing::study::report
