#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "common/result/result.h"
#include "common/statistics/samples.h"
#include "common/statistics/steel.h"
#include "common/statistics/study_table.h"

namespace footing::statistics {

enum class TestKind { kDunnett, kSteel, kPaired, kRate };

struct AnalysisRequest {
  TestKind test = TestKind::kSteel;
  Alternative alternative = Alternative::kTwoSided;
  Ties ties = Ties::kPairwise;   ///< Steel only.
  std::optional<Method> method;  ///< Without: the one that the test prefers.
  std::uint64_t seed = 1;
  std::size_t permutations = 100'000;
  double confidence = 0.95;  ///< In (0.5, 1), of all comparisons of a table together.
};

/// How the table of a test is to be read.
TableUse UseOf(TestKind test);

/// The names of command lines and of reports: "steel", "two.sided", "exact".
std::string_view NameOf(TestKind test);
std::string_view NameOf(Alternative alternative);
std::string_view NameOf(Method method);
std::string_view NameOf(Ties ties);

/// The report of a test, a table of one row per treatment with a note on which p to believe;
/// docs/statistics.md lists its fields. UsageError for a method that the test does not have.
Result<nlohmann::ordered_json> Analyze(const StudyTable& table, const AnalysisRequest& request);

}  // namespace footing::statistics
