#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
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

/// What a command line may name, and what it is without a name.
inline constexpr std::array kTests{TestKind::kDunnett, TestKind::kSteel, TestKind::kPaired,
                                   TestKind::kRate};
inline constexpr std::array kAlternatives{Alternative::kTwoSided, Alternative::kGreater,
                                          Alternative::kLess};
inline constexpr std::array kAllTies{Ties::kPairwise, Ties::kJoint};
inline constexpr std::array kMethods{Method::kExact, Method::kPermutation, Method::kAsymptotic};

template <typename Enum, std::size_t count>
std::vector<std::string> NamesOf(const std::array<Enum, count>& all) {
  std::vector<std::string> names;
  for (const Enum value : all) names.emplace_back(NameOf(value));
  return names;
}
/// The one of that name; the first one where none has it.
template <typename Enum, std::size_t count>
Enum Named(std::string_view name, const std::array<Enum, count>& all) {
  for (const Enum value : all) {
    if (NameOf(value) == name) return value;
  }
  return all.front();
}

/// The report of a test, a table of one row per treatment with a note on which p to believe;
/// docs/statistics.md lists its fields. UsageError for a method that the test does not have.
Result<nlohmann::ordered_json> Analyze(const StudyTable& table, const AnalysisRequest& request);

}  // namespace footing::statistics
