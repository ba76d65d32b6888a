// Data that leave a formula without a denominator: every figure stays a number in its range.
#include <gtest/gtest.h>

#include <cmath>

#include "common/statistics/analysis.h"

namespace footing::statistics {
namespace {

using nlohmann::ordered_json;

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

}  // namespace
}  // namespace footing::statistics
