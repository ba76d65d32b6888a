#include "common/statistics/analysis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

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
}  // namespace footing::statistics
