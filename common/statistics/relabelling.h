#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/statistics/samples.h"

/// Tests by relabelling: where nothing differs, every assignment of labels to values is as likely
/// as the observed one.
namespace footing::statistics {

struct Relabelling {
  /// Without: exact where `most_tables` allow it, otherwise random.
  std::optional<Method> method;
  std::uint64_t seed = 1;
  std::size_t permutations = 100'000;   ///< Random ones.
  std::size_t most_tables = 4'000'000;  ///< That an exact test runs through.
};

/// Of one comparison.
struct RelabelledRow {
  double p = 1;  ///< Adjusted: share of relabellings whose greatest evidence reaches this one's.
  double standard_error = 0;  ///< Of p, from random relabelling; 0 if exact.
  double smallest_p = 0;      ///< The least that p can be with these values; 0 if unknown.
};

struct Relabelled {
  Method method = Method::kExact;
  double relabellings = 0;  ///< Distinct tables run through, or random draws.
  std::vector<RelabelledRow> rows;
};

/// Takes the evidence of each comparison under one relabelling, and its probability.
using TakeEvidence = std::function<void(const std::vector<double>& evidence, double probability)>;
/// Runs through all relabellings, unless there are more than `most`: then false.
using RunThroughAll = std::function<bool(std::size_t most, const TakeEvidence& take)>;
/// The evidence under a random relabelling; it lasts until the next one.
using DrawEvidence = std::function<const std::vector<double>&(std::mt19937_64& engine)>;

/// Single-step adjusted p of each comparison. Evidence counts as reached within `tolerance`.
Result<Relabelled> CompareWithRelabellings(const std::vector<double>& observed, double tolerance,
                                           const Relabelling& relabelling,
                                           const RunThroughAll& run_through_all,
                                           const DrawEvidence& draw);

/// A whole number in [0, count), evenly, the same bits everywhere.
std::size_t DrawBelow(std::mt19937_64& engine, std::size_t count);

/// Random order, each as likely.
template <typename Value>
void Shuffle(std::vector<Value>& values, std::mt19937_64& engine) {
  for (std::size_t i = values.size(); i > 1; --i) {
    std::swap(values[i - 1], values[DrawBelow(engine, i)]);
  }
}

}  // namespace footing::statistics
