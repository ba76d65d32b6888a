#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/statistics/analysis.h"
#include "common/statistics/within_subject.h"
#include "tests/common/statistics/reference.h"

namespace footing::statistics {
namespace {

using nlohmann::ordered_json;

constexpr Alternative kAll[] = {Alternative::kTwoSided, Alternative::kGreater, Alternative::kLess};

struct Case {
  TestKind test;
  std::optional<Method> method;
  Ties ties = Ties::kPairwise;
};

const std::vector<Case>& Cases() {
  static const std::vector<Case> cases = {{TestKind::kDunnett, {}},
                                          {TestKind::kSteel, Method::kExact},
                                          {TestKind::kSteel, Method::kExact, Ties::kJoint},
                                          {TestKind::kSteel, Method::kAsymptotic},
                                          {TestKind::kSteel, Method::kAsymptotic, Ties::kJoint},
                                          {TestKind::kPaired, Method::kExact},
                                          {TestKind::kPaired, Method::kAsymptotic}};
  return cases;
}

/// Four subjects in three groups, with ties; values that sums and negation leave exact.
StudyTable Table() {
  return ParseStudyTable(
             "subject,group_index,group,value\n"
             "p1,0,stick,3\np1,1,wrist,5\np1,2,arm,4.5\np2,0,stick,1\np2,1,wrist,3\n"
             "p2,2,arm,1\np3,0,stick,6\np3,1,wrist,6.5\np3,2,arm,8\np4,0,stick,2\n"
             "p4,1,wrist,5\np4,2,arm,4\n",
             {"data.csv", "", TableUse::kPaired})
      .value();
}

/// Every value changed.
StudyTable Changed(StudyTable table, const std::function<double(double)>& change) {
  for (Group& group : table.groups) {
    for (double& value : group.values) value = change(value);
  }
  for (auto& row : table.blocks->values) {
    for (double& value : row) value = change(value);
  }
  return table;
}

ordered_json RunTest(const StudyTable& table, const Case& one, Alternative alternative) {
  AnalysisRequest request;
  request.test = one.test;
  request.method = one.method;
  request.ties = one.ties;
  request.alternative = alternative;
  const auto report = Analyze(table, request);
  EXPECT_TRUE(report) << report.error().message;
  return report.value();
}

double NumberAt(const ordered_json& row, const char* name) { return row.at(name).get<double>(); }

const char* const kPNames[] = {
    "p", "paired_p", "block_dunnett_p", "wilcoxon_p", "wilcoxon_exact_holm", "permutation_p"};

void ExpectSameP(const ordered_json& left, const ordered_json& right) {
  ASSERT_EQ(left.at("rows").size(), right.at("rows").size());
  for (std::size_t i = 0; i < left.at("rows").size(); ++i) {
    const ordered_json &a = left.at("rows")[i], &b = right.at("rows")[i];
    for (const char* const name : kPNames) {
      ASSERT_EQ(a.contains(name), b.contains(name));
      if (!a.contains(name)) continue;
      EXPECT_NEAR(NumberAt(a, name), NumberAt(b, name), 1e-12) << name;
    }
  }
}

void ForEachCase(const std::function<void(const Case& one, Alternative alternative)>& check) {
  for (const Case& one : Cases()) {
    for (const Alternative alternative : kAll) {
      SCOPED_TRACE(std::string(NameOf(one.test)) + " " + std::string(NameOf(alternative)));
      check(one, alternative);
    }
  }
}

TEST(Analysis, IsBlindToTheOrderOfRows) {
  StudyTable turned = Table();
  for (Group& group : turned.groups) std::reverse(group.values.begin(), group.values.end());
  auto& values = turned.blocks->values;
  std::rotate(values.begin(), values.begin() + 1, values.end());
  ForEachCase([&](const Case& one, Alternative alternative) {
    ExpectSameP(RunTest(Table(), one, alternative), RunTest(turned, one, alternative));
  });
}

TEST(Analysis, IsBlindToAnAddedConstantAndToTheUnit) {
  const StudyTable raised = Changed(Table(), [](double value) { return 1024 + value; });
  const StudyTable scaled = Changed(Table(), [](double value) { return value / 1024; });
  ForEachCase([&](const Case& one, Alternative alternative) {
    const ordered_json plain = RunTest(Table(), one, alternative);
    ExpectSameP(plain, RunTest(raised, one, alternative));
    ExpectSameP(plain, RunTest(scaled, one, alternative));
    const double estimate = NumberAt(plain.at("rows")[0], "estimate");
    EXPECT_NEAR(NumberAt(RunTest(raised, one, alternative).at("rows")[0], "estimate"), estimate,
                1e-12);
    EXPECT_NEAR(NumberAt(RunTest(scaled, one, alternative).at("rows")[0], "estimate") * 1024,
                estimate, 1e-12);
  });
}

TEST(Analysis, OfNegatedValuesHasTheOtherAlternative) {
  const StudyTable negated = Changed(Table(), [](double value) { return -value; });
  const Alternative mirrored[] = {Alternative::kTwoSided, Alternative::kLess,
                                  Alternative::kGreater};
  for (const Case& one : Cases()) {
    for (std::size_t i = 0; i < 3; ++i) {
      const ordered_json plain = RunTest(Table(), one, kAll[i]);
      const ordered_json mirror = RunTest(negated, one, mirrored[i]);
      ExpectSameP(plain, mirror);
      for (std::size_t row = 0; row < 2; ++row) {
        EXPECT_NEAR(NumberAt(plain.at("rows")[row], "estimate"),
                    -NumberAt(mirror.at("rows")[row], "estimate"), 1e-12);
      }
    }
  }
}

TEST(Analysis, RankTestsAreBlindToAMonotoneChange) {
  const StudyTable changed = Changed(Table(), [](double value) { return std::exp(value); });
  for (const Alternative alternative : kAll) {
    for (const Case& one : Cases()) {
      if (one.test != TestKind::kSteel) continue;
      const ordered_json plain = RunTest(Table(), one, alternative),
                         other = RunTest(changed, one, alternative);
      for (std::size_t row = 0; row < 2; ++row) {
        EXPECT_NEAR(NumberAt(plain.at("rows")[row], "p"), NumberAt(other.at("rows")[row], "p"),
                    1e-14);
      }
    }
  }
}

TEST(Analysis, TwoSidedPIsAtLeastTheSmallerOneSidedOne) {
  for (const Case& one : Cases()) {
    for (std::size_t row = 0; row < 2; ++row) {
      double p[3];
      for (std::size_t i = 0; i < 3; ++i) {
        p[i] = NumberAt(RunTest(Table(), one, kAll[i]).at("rows")[row], "p");
        EXPECT_GT(p[i], 0);
        EXPECT_LE(p[i], 1);
      }
      EXPECT_GE(p[0], std::min(p[1], p[2]) - 1e-15);
      EXPECT_GE(p[1] + p[2], 1 - 1e-12);  // Both count what equals the observed.
    }
  }
}

TEST(Analysis, NobodyIsToBelieveThePairedPOfOneSubject) {
  const auto table =
      ParseStudyTable("subject,group_index,group,value\np1,0,stick,3\np1,1,wrist,5\n",
                      {"data.csv", "", TableUse::kIndependent});
  ASSERT_TRUE(table) << table.error().message;
  const auto report = RunTest(*table, {TestKind::kSteel, {}}, Alternative::kTwoSided);
  EXPECT_EQ(report.at("note").get<std::string>().find("Believe the paired p"), std::string::npos);
}

TEST(Analysis, NoteNamesWhatToBelieve) {
  const auto note = [](const StudyTable& table, const Case& one) {
    return RunTest(table, one, Alternative::kTwoSided).at("note").get<std::string>();
  };
  StudyTable independent = Table();
  independent.blocks.reset();
  const Case steel = {TestKind::kSteel, {}}, dunnett = {TestKind::kDunnett, {}};
  EXPECT_NE(note(Table(), steel).find("Believe the paired p"), std::string::npos);
  EXPECT_NE(note(Table(), steel).find("4 subjects"), std::string::npos);
  EXPECT_NE(note(independent, dunnett).find("believe the paired test"), std::string::npos);
  EXPECT_NE(note(Table(), {TestKind::kPaired, {}}).find("Believe p:"), std::string::npos);
  EXPECT_NE(note(Table(), {TestKind::kPaired, Method::kAsymptotic}).find("Believe permutation_p"),
            std::string::npos);
  // 4 subjects: at best 2 comparisons x 2 / 2^4.
  EXPECT_NE(
      note(Table(), {TestKind::kPaired, {}}).find("wilcoxon_exact_holm can never be below 0.25"),
      std::string::npos);
}

TEST(Analysis, NobodyIsToBelieveAPOfSubjectsThatRepeatButCannotBePaired) {
  const auto note = [](const std::string& rows) {
    const auto table = ParseStudyTable("subject,group_index,group,value\n" + rows,
                                       {"study.csv", "", TableUse::kIndependent});
    EXPECT_TRUE(table) << table.error().message;
    const auto report = RunTest(*table, {TestKind::kSteel, {}}, Alternative::kTwoSided);
    return report.at("note").get<std::string>();
  };
  const std::string twice = note("p1,0,stick,1\np1,0,stick,2\np2,1,wrist,3\np2,0,stick,4\n");
  EXPECT_NE(twice.find("Do not believe p"), std::string::npos) << twice;
  EXPECT_NE(twice.find("study.csv, line 3: subject 'p1' has a second value"), std::string::npos);
  const std::string missing = note("p1,0,stick,1\np1,1,wrist,2\np2,1,wrist,3\n");
  EXPECT_NE(missing.find("Do not believe p"), std::string::npos) << missing;
  EXPECT_NE(missing.find("subject 'p2' has no value for group 'stick'"), std::string::npos);
  // Everybody in one group only: independent groups.
  const std::string once = note("p1,0,stick,1\np2,1,wrist,2\np3,1,wrist,3\n");
  EXPECT_NE(once.find("Believe p only if every group has other subjects"), std::string::npos)
      << once;
}

TEST(Analysis, NoteSaysWhenTheExactPCannotReachTheLevel) {
  const StudyTable three = {
      {{"stick", {1, 2, 3}}, {"arm", {7, 8, 9}}, {"leg", {4, 5, 6}}, {"wrist", {10, 11, 12}}},
      {},
      {}};
  for (const auto method : {Method::kExact, Method::kPermutation, Method::kAsymptotic}) {
    // 369 600 tables are more than a note is worth, but not more than the exact test.
    const StudyTable few = {{three.groups[0], three.groups[1]}, {}, {}};
    const std::string note = RunTest(few, {TestKind::kSteel, method}, Alternative::kTwoSided)
                                 .at("note")
                                 .get<std::string>();
    EXPECT_NE(note.find("can never be below 0.05"), std::string::npos) << note;
    EXPECT_NE(note.find("(smallest possible: 0.1)"), std::string::npos) << note;
  }
  const std::string note =
      RunTest(three, {TestKind::kSteel, {}}, Alternative::kTwoSided).at("note").get<std::string>();
  EXPECT_NE(note.find("can never be below 0.05"), std::string::npos) << note;
}

TEST(Analysis, APOfExactlyTheLevelIsNotBelowIt) {
  // One of the 20 orders of 3 and 3 values: 0.05.
  const StudyTable table = {{{"stick", {1, 2, 3}}, {"arm", {7, 8, 9}}}, {}, {}};
  const ordered_json report = RunTest(table, {TestKind::kSteel, {}}, Alternative::kGreater);
  EXPECT_NEAR(NumberAt(report.at("rows")[0], "p"), 0.05, 1e-15);
  EXPECT_NE(report.at("note").get<std::string>().find("can never be below 0.05"),
            std::string::npos);
}

TEST(Analysis, RateReportsBothModelsAndThePapersReason) {
  StudyTable counts = {{{"stick", {5, 9, 2, 14, 7, 3, 11, 6}}, {"wrist", {2, 4, 1, 6, 3, 0, 5, 2}}},
                       {std::vector<double>(8, 1), std::vector<double>(8, 1)},
                       {}};
  const ordered_json report = RunTest(counts, {TestKind::kRate, {}}, Alternative::kTwoSided);
  const ordered_json& row = report.at("rows")[0];
  EXPECT_NEAR(NumberAt(row, "estimate"), 23.0 / 57, 1e-12);
  EXPECT_EQ(row.at("p"), row.at("negative_binomial").at("p"));
  const std::string note = report.at("note").get<std::string>();
  EXPECT_NE(note.find("footnote 1"), std::string::npos);
  EXPECT_NE(note.find("Poisson p beside it are too small"), std::string::npos) << note;
  const ordered_json exact =
      RunTest(counts, {TestKind::kRate, Method::kExact}, Alternative::kTwoSided);
  EXPECT_EQ(exact.at("rows")[0].at("p"), row.at("poisson").at("p"));
}

TEST(Analysis, RefusesMethodsThatATestDoesNotHave) {
  AnalysisRequest request;
  request.test = TestKind::kDunnett;
  request.method = Method::kExact;
  ASSERT_FALSE(Analyze(Table(), request));
  EXPECT_EQ(Analyze(Table(), request).error().kind, ErrorKind::kUsage);
  request.test = TestKind::kRate;
  request.method = Method::kPermutation;
  StudyTable counts = Table();
  EXPECT_EQ(Analyze(counts, request).error().kind, ErrorKind::kUsage);
}

}  // namespace

// Data that leave a formula without a denominator: every figure stays a number in its range.
namespace {

/// Finite, and p within [0, 1]; an open end of an interval is null.
void ExpectNumbers(const ordered_json& value, const std::string& name) {
  if (value.is_object() || value.is_array()) {
    for (const auto& [key, inner] : value.items()) {
      ExpectNumbers(inner, value.is_array() ? name : key);
    }
    return;
  }
  const bool open = name == "low" || name == "high" || name == "df" ||
                    name == "standard_deviation" || name == "estimate";
  if (value.is_null()) {
    EXPECT_TRUE(open) << name;
    return;
  }
  if (!value.is_number()) return;
  EXPECT_TRUE(std::isfinite(value.get<double>())) << name;
  const bool p = name == "p" || name.ends_with("_p") || name.ends_with("_holm");
  if (p) {
    EXPECT_GE(value.get<double>(), 0) << name;
    EXPECT_LE(value.get<double>(), 1) << name;
  }
}

StudyTable TableOf(const std::vector<std::vector<double>>& groups) {
  StudyTable table;
  Blocks blocks;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    table.groups.push_back({std::string(1, static_cast<char>('a' + i)), groups[i]});
    table.exposures.emplace_back(groups[i].size(), 1.0);
    blocks.groups.push_back(table.groups.back().name);
  }
  bool equal_sizes = true;
  for (const auto& group : groups) equal_sizes = equal_sizes && group.size() == groups[0].size();
  if (!equal_sizes || groups[0].size() < 2) return table;
  for (std::size_t subject = 0; subject < groups[0].size(); ++subject) {
    blocks.subjects.push_back(std::to_string(subject));
    std::vector<double>& row = blocks.values.emplace_back();
    for (const auto& group : groups) row.push_back(group[subject]);
  }
  table.blocks = blocks;
  return table;
}

/// All tests, methods and alternatives that apply; the reports by test.
std::vector<ordered_json> RunAll(const StudyTable& table) {
  std::vector<ordered_json> reports;
  const std::optional<Method> methods[] = {
      {}, Method::kExact, Method::kPermutation, Method::kAsymptotic};
  for (const auto test :
       {TestKind::kDunnett, TestKind::kSteel, TestKind::kPaired, TestKind::kRate}) {
    if (test == TestKind::kPaired && !table.blocks) continue;
    for (const auto& method : methods) {
      for (const auto alternative :
           {Alternative::kTwoSided, Alternative::kGreater, Alternative::kLess}) {
        for (const auto ties : {Ties::kPairwise, Ties::kJoint}) {
          AnalysisRequest request;
          request.test = test;
          request.method = method;
          request.alternative = alternative;
          request.ties = ties;
          request.permutations = 200;
          const auto report = Analyze(table, request);
          if (!report) {
            EXPECT_EQ(report.error().kind, ErrorKind::kUsage) << report.error().message;
            continue;
          }
          SCOPED_TRACE(report->at("procedure").get<std::string>());
          ExpectNumbers(*report, "");
          EXPECT_EQ(report->at("rows").size(), table.groups.size() - 1);
          reports.push_back(*report);
        }
      }
    }
  }
  EXPECT_GT(reports.size(), 20u);
  return reports;
}

TEST(DegenerateData, OfEqualValuesHaveNoDifference) {
  for (const ordered_json& report : RunAll(TableOf({{3, 3, 3}, {3, 3, 3}, {3, 3, 3}}))) {
    if (report.at("test") == "rate") continue;
    for (const ordered_json& row : report.at("rows")) {
      EXPECT_EQ(row.at("p"), 1) << report.dump();
      EXPECT_EQ(row.at("statistic"), 0);
      EXPECT_EQ(row.at("estimate"), 0);
    }
  }
}

TEST(DegenerateData, OfOnePairWithoutVarianceAffectNoOther) {
  const auto reports = RunAll(TableOf({{2, 2, 2, 2}, {2, 2, 2, 2}, {1, 3, 5, 7}}));
  for (const ordered_json& report : reports) {
    if (report.at("test") != "steel") continue;
    const bool pairwise = report.at("ties") == "pairwise";
    EXPECT_TRUE(!pairwise || report.at("rows")[0].at("p") == 1) << report.dump();
    EXPECT_EQ(report.at("rows")[0].at("statistic"), 0);
  }
}

TEST(DegenerateData, WithoutVarianceWithinGroupsAreSaidToBeSo) {
  const auto reports = RunAll(TableOf({{1, 1, 1}, {2, 2, 2}, {1, 1, 1}}));
  int dunnett = 0;
  for (const ordered_json& report : reports) {
    if (report.at("test") != "dunnett") continue;
    ++dunnett;
    EXPECT_NE(report.at("note").get<std::string>().find("p says nothing"), std::string::npos);
    EXPECT_EQ(report.at("rows")[1].at("p"), 1);
    const double expected = report.at("alternative") == "less" ? 1 : 0;
    EXPECT_EQ(report.at("rows")[0].at("p"), expected);
  }
  EXPECT_GT(dunnett, 0);
}

TEST(DegenerateData, OfTwoValuesInAGroup) { RunAll(TableOf({{1, 2}, {3, 5}})); }

TEST(DegenerateData, OfOneValueInTheControl) { RunAll(TableOf({{1}, {3, 5, 4}, {2}})); }

TEST(DegenerateData, OfOneValueInEachGroupHaveAnAsymptoticP) {
  const Groups groups = {{"control", {1}}, {"treatment", {2}}};
  for (const Ties ties : {Ties::kPairwise, Ties::kJoint}) {
    const auto p = SteelAsymptotic(groups, Alternative::kTwoSided, {.ties = ties});
    // U is 0 or 1, so its deviation is 1/2 and z = 1: p = 2 (1 - Phi(1)).
    EXPECT_NEAR(p.at(0), std::erfc(1 / std::sqrt(2.0)), 1e-10);
  }
}

TEST(DegenerateData, OfGreatAndSmallScale) {
  RunAll(TableOf({{0, 2, 1, 0}, {0, 0, 0, 1}, {0, 0, 0, 0}}));
  for (const double scale : {1e100, 1e-100, 5e-324}) {
    StudyTable table = TableOf({{1, 2, 1, 3}, {2, 3, 3, 5}});
    for (Group& group : table.groups) {
      for (double& value : group.values) value *= scale;
    }
    for (auto& row : table.blocks->values) {
      for (double& value : row) value *= scale;
    }
    AnalysisRequest request;
    for (const auto test : {TestKind::kDunnett, TestKind::kSteel, TestKind::kPaired}) {
      request.test = test;
      const auto report = Analyze(table, request);
      ASSERT_TRUE(report);
      ExpectNumbers(*report, "");
    }
  }
}

TEST(DegenerateData, OfManyGroups) {
  std::vector<std::vector<double>> groups;
  for (int i = 0; i < 20; ++i) groups.push_back({0.0 + i % 3, 1.0 + i % 4, 2.0 + i % 5});
  AnalysisRequest request;
  request.permutations = 500;
  for (const auto test :
       {TestKind::kDunnett, TestKind::kSteel, TestKind::kPaired, TestKind::kRate}) {
    request.test = test;
    const auto report = Analyze(TableOf(groups), request);
    ASSERT_TRUE(report) << report.error().message;
    ExpectNumbers(*report, "");
  }
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const double kEqualGroups = 1 / std::numbers::sqrt2;

ManyToOne Family(std::vector<double> loadings, double degrees, bool two_sided) {
  return {std::move(loadings), degrees, two_sided};
}

/// With one treatment the loading has no effect: T is Student's t, whose tails for 1, 2 and 4
/// degrees of freedom are elementary functions.
double StudentTail(double t, double degrees) {
  if (degrees == 1) return std::atan(1 / t) / std::numbers::pi;
  if (degrees == 2) return 1 / (std::hypot(t, std::sqrt(2)) * (std::hypot(t, std::sqrt(2)) + t));
  return 0.5 * std::erfc(t / std::numbers::sqrt2);
}

TEST(MaxTail, OfOneTreatmentIsStudentsTailToTenDigitsFarOut) {
  for (const double loading : {0.1, kEqualGroups, 0.95, 0.999}) {
    for (const double degrees : {1.0, 2.0, kInfinity}) {
      for (const double t : {0.3, 1.0, 3.0, 7.0, 12.0, 25.0, 1e3, 1e6, 1e12}) {
        if (std::isinf(degrees) && t > 30) continue;  // Below the smallest double.
        const double tail = StudentTail(t, degrees);
        EXPECT_NEAR(MaxTail(Family({loading}, degrees, false), t) / tail, 1, 1e-10)
            << loading << " " << degrees << " " << t;
        EXPECT_NEAR(MaxTail(Family({loading}, degrees, true), t) / (2 * tail), 1, 1e-10)
            << loading << " " << degrees << " " << t;
      }
    }
  }
}

TEST(MaxTail, AtZeroIsTheChanceThatTheControlIsNotTheGreatest) {
  // Each of k + 1 equal groups is the greatest equally often: 1 - 1 / (k + 1).
  for (int k = 1; k <= 12; ++k) {
    for (const double degrees : {1.0, 7.0, kInfinity}) {
      const std::vector<double> loadings(static_cast<std::size_t>(k), kEqualGroups);
      EXPECT_NEAR(MaxTail(Family(loadings, degrees, false), 0), 1 - 1.0 / (k + 1), 1e-14);
    }
  }
}

TEST(MaxTail, OfManyTreatmentsFarOutIsTheSumOfTheirTails) {
  // P(any) = sum P - P(two at once), and two at once are rarer by orders of magnitude.
  const std::vector<double> loadings = {0.3, 0.5, kEqualGroups};
  for (const double t : {8.0, 12.0}) {
    const double sum = 3 * std::erfc(t / std::numbers::sqrt2);
    EXPECT_NEAR(MaxTail(Family(loadings, kInfinity, true), t) / sum, 1, 1e-6) << t;
  }
}

TEST(MaxTail, GrowsWithTheOrderOfUnequalLoadingsIrrelevant) {
  const double tail = MaxTail(Family({0.2, 0.9, 0.6}, 11, true), 2.2);
  EXPECT_NEAR(MaxTail(Family({0.9, 0.6, 0.2}, 11, true), 2.2), tail, 1e-15);
  EXPECT_GT(MaxTail(Family({0.9, 0.6, 0.2, 0.6}, 11, true), 2.2), tail);
}

TEST(MaxTail, OfManyDegreesIsThatOfTheNormalLimit) {
  const std::vector<double> loadings(4, kEqualGroups);
  const double limit = MaxTail(Family(loadings, kInfinity, true), 2.5);
  // The first correction is of the order 1 / degrees.
  EXPECT_NEAR(MaxTail(Family(loadings, 1e9, true), 2.5), limit, 1e-9);
  EXPECT_NEAR(MaxTail(Family(loadings, 1e4, true), 2.5), limit, 1e-4);
}

TEST(MaxTail, AtTheEndsIsZeroOrOneAndNeverNaN) {
  constexpr double kGreatest = std::numeric_limits<double>::max();
  for (const double degrees : {1.0, 30.0, kInfinity}) {
    for (const double t : {kInfinity, kGreatest}) {
      for (const bool two_sided : {false, true}) {
        const double tail = MaxTail(Family({0.5, 0.8}, degrees, two_sided), t);
        EXPECT_GE(tail, 0);
        EXPECT_LT(tail, 1e-300);
      }
      EXPECT_EQ(MaxTail(Family({0.5, 0.8}, degrees, false), -t), 1);
    }
    EXPECT_EQ(MaxTail(Family({0.5}, degrees, true), 0), 1);
  }
}

TEST(MaxQuantile, FulfilsItsDefinition) {
  for (const double tail : {0.3, 0.05, 1e-4, 1e-9}) {
    for (const double degrees : {1.0, 3.0, 40.0, kInfinity}) {
      for (const bool two_sided : {false, true}) {
        const ManyToOne family = Family({0.4, 0.6, 0.9}, degrees, two_sided);
        EXPECT_NEAR(MaxTail(family, MaxQuantile(family, tail)) / tail, 1, 1e-9);
      }
    }
  }
}

TEST(MaxQuantile, RoundsToDunnettsPrintedTable) {
  // One-sided 5 % points of three treatments (Dunnett 1955): 2.34, 2.19 and 2.06.
  const std::vector<double> three(3, kEqualGroups);
  EXPECT_NEAR(MaxQuantile(Family(three, 10, false), 0.05), 2.34, 0.005);
  EXPECT_NEAR(MaxQuantile(Family(three, 20, false), 0.05), 2.19, 0.005);
  EXPECT_NEAR(MaxQuantile(Family(three, kInfinity, false), 0.05), 2.06, 0.005);
}

TEST(MaxQuantile, AgreesWithTheTableOfCriticalValues) {
  SKIP_WITHOUT_REFERENCE_TABLES();
  const auto rows = test::ReadReference("dunnett_critical_values.csv");
  ASSERT_GE(rows.size(), 100u);
  for (const auto& row : rows) {
    const std::vector<double> loadings(std::stoul(row.at("k_treatments")), kEqualGroups);
    const double degrees = test::NumberIn(row, "df"), alpha = test::NumberIn(row, "alpha");
    EXPECT_NEAR(MaxQuantile(Family(loadings, degrees, true), alpha),
                test::NumberIn(row, "two_sided"), 1e-10);
    EXPECT_NEAR(MaxQuantile(Family(loadings, degrees, false), alpha),
                test::NumberIn(row, "one_sided"), 1e-10);
  }
}

using testing::ElementsAre;

// R: quantile(c(7, 1, 3, 2), c(0, 0.25, 0.5, 0.95, 1)).
TEST(Quantile, IsLinearBetweenTheTwoNearestValues) {
  const std::vector<double> values = {7, 1, 3, 2};
  EXPECT_EQ(QuantileOf(values, 0), 1);
  EXPECT_DOUBLE_EQ(QuantileOf(values, 0.25), 1.75);
  EXPECT_DOUBLE_EQ(QuantileOf(values, 0.95), 6.4);
  EXPECT_EQ(QuantileOf(values, 1), 7);
  EXPECT_EQ(MedianOf(values), 2.5);
  EXPECT_EQ(MedianOf({5}), 5);
}

TEST(MeanRanks, TiedValuesShareTheMeanOfTheirRanks) {
  const MeanRanks ranked = RankWithTies({-1, 4, -1, 0, 4, 4});
  EXPECT_THAT(ranked.ranks, ElementsAre(1.5, 5, 1.5, 3, 5, 5));
  EXPECT_EQ(ranked.tie_sum, (8 - 2) + (27 - 3));
}

TEST(MeanRanks, ValuesThatDifferByRoundingAreTiedWhereThatIsAsked) {
  const std::vector<double> values = {0.3 - 0.1, 0.2, 0.25};
  ASSERT_NE(values[0], values[1]);
  EXPECT_EQ(RankWithTies(values).tie_sum, 0);
  EXPECT_THAT(RankWithTies(values, 1e-12).ranks, ElementsAre(1.5, 1.5, 3));
}

}  // namespace
}  // namespace footing::statistics
