#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/runtime/clock.h"
#include "common/statistics/dunnett.h"
#include "common/virtual/devices/random.h"
#include "daemon/offline/bench/pairs.h"

namespace footing::bench {
namespace {

constexpr int kDunnettPairs = 15;
constexpr int kDunnettGroups = 5;
constexpr std::size_t kDunnettValues = 100;
constexpr double kDunnettConfidence = 0.95;

/// The group at `i` has `fewer` * i values less than 100.
statistics::Groups DunnettGroups(std::size_t fewer) {
  noise::Random random(1);
  statistics::Groups groups;
  for (std::size_t i = 0; i < kDunnettGroups; ++i) {
    statistics::Group& group = groups.emplace_back();
    for (std::size_t k = 0; k < kDunnettValues - fewer * i; ++k) {
      group.values.push_back(0.1 * static_cast<double>(i) + random.Normal());
    }
  }
  return groups;
}

double Phi(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

/// Two-sided p of one comparison among equal groups: 30 nodes per unit of y in [-12, 12], 20 nodes
/// on 24 pieces of s.
double GaussP(double t, double degrees, double treatments) {
  using boost::math::quadrature::gauss;
  const double loading = 1 / std::numbers::sqrt2;
  const auto given_s = [&](double s) {
    double sum = 0;
    for (int piece = -12; piece < 12; ++piece) {
      sum += gauss<double, 30>::integrate(
          [&](double y) {
            const double inside =
                Phi((t * s - loading * y) / loading) - Phi((-t * s - loading * y) / loading);
            return std::exp(-y * y / 2) * (1 - std::pow(inside, treatments));
          },
          piece, piece + 1);
    }
    return sum / std::sqrt(2 * std::numbers::pi);
  };
  const double half = degrees / 2;
  const double log_constant = std::log(2) + half * std::log(half) - std::lgamma(half);
  const double reach = 8 / std::sqrt(2 * degrees), step = 2 * reach / 24;
  double p = 0;
  for (int piece = 0; piece < 24; ++piece) {
    const double from = 1 - reach + piece * step;
    p += gauss<double, 20>::integrate(
        [&](double s) {
          return std::exp(log_constant + (degrees - 1) * std::log(s) - half * s * s) * given_s(s);
        },
        from, from + step);
  }
  return p;
}

template <typename Function>
double CostMs(const Function& function) {
  const std::int64_t begin_ns = clock::ThreadCpuNs();
  function();
  return static_cast<double>(clock::ThreadCpuNs() - begin_ns) / 1e6;
}

}  // namespace

Result<Rows> DunnettTest() {
  const statistics::Groups equal = DunnettGroups(0), unequal = DunnettGroups(7);
  constexpr auto kBoth = statistics::Alternative::kTwoSided;
  const auto reference = statistics::DunnettTest(equal, kBoth, kDunnettConfidence);
  if (!reference) return reference.error();
  double difference = 0;
  const auto ours = [&](const statistics::Groups& groups) {
    return CostMs([&] {
      const auto test = statistics::DunnettTest(groups, kBoth, kDunnettConfidence);
      if (!test) difference = 1;
    });
  };
  const auto gauss = [&] {
    return CostMs([&] {
      for (const statistics::DunnettRow& row : reference->rows) {
        const double p = GaussP(std::abs(row.t), reference->degrees, kDunnettGroups - 1);
        difference = std::max(difference, std::abs(p - row.p));
      }
    });
  };
  const char* const unit = "ms CPU (baseline: the p alone, of equal groups, by Gauss nodes)";
  Rows rows = {
      RunPairs(
          "dunnett_5x100_ms", unit, kDunnettPairs, [&] { return ours(equal); }, gauss),
      RunPairs(
          "dunnett_5_unequal_ms", unit, kDunnettPairs, [&] { return ours(unequal); }, gauss)};
  if (difference > 1e-10) return Failure("Dunnett's p differs from that by Gauss nodes");
  return rows;
}

}  // namespace footing::bench
