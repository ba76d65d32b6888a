#include "common/virtual/devices/link_model.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "common/base/units.h"

namespace footing::virtual_devices {
namespace {

/// One point of a distribution of intervals.
struct Quantile {
  double probability;  // 1
  double interval_ms;  // ms
};

constexpr Quantile kGood[] = {{0, 1},     {0.01, 2},  {0.05, 3},  {0.25, 7},   {0.5, 11},
                              {0.75, 15}, {0.95, 25}, {0.99, 30}, {0.999, 43}, {1, 60}};
constexpr Quantile kPoor[] = {{0, 1},     {0.01, 1},  {0.05, 2},  {0.25, 7},    {0.5, 13},
                              {0.75, 21}, {0.95, 44}, {0.99, 80}, {0.999, 162}, {1, 250}};

/// The recordings' own rate on a good link: intervals scale by this over the nominal rate.
constexpr double kRecordedGoodHz = 83.6;
constexpr double kOutagesPerSecond = 1.0 / 120;
constexpr double kOutageMeanS = 1;
constexpr double kOutageMinS = 0.1;
constexpr double kOutageMaxS = 20;

template <std::size_t N>
double AtProbability(const Quantile (&table)[N], double probability) {
  for (std::size_t i = 1; i < N; ++i) {
    if (probability > table[i].probability) continue;
    const double share = (probability - table[i - 1].probability) /
                         (table[i].probability - table[i - 1].probability);
    return std::lerp(table[i - 1].interval_ms, table[i].interval_ms, share);
  }
  return table[N - 1].interval_ms;
}

}  // namespace

std::optional<LinkQuality> LinkNamed(const std::string& name) {
  if (name == "ideal") return LinkQuality::kIdeal;
  if (name == "good") return LinkQuality::kGood;
  if (name == "poor") return LinkQuality::kPoor;
  return std::nullopt;
}

LinkConfig WiimoteLink(LinkQuality quality, std::uint64_t seed) {
  return {quality, 100, 100, seed};
}

LinkConfig BoardLink(LinkQuality quality, std::uint64_t seed) {
  return {quality, 60, kRecordedGoodHz, seed};
}

LinkConfig JoyconLink(LinkQuality quality, std::uint64_t seed) {
  return {quality, 1 / 0.015, kRecordedGoodHz, seed, true};
}

LinkModel::LinkModel(const LinkConfig& config, std::int64_t start_ns)
    : config_(config), random_(config.seed), start_ns_(start_ns), last_ns_(start_ns) {}

double LinkModel::DrawInterval() {
  const double u = random_.Uniform();
  if (config_.most_turn_s > 0) return std::lerp(config_.least_turn_s, config_.most_turn_s, u);
  const double ms =
      config_.quality == LinkQuality::kGood ? AtProbability(kGood, u) : AtProbability(kPoor, u);
  return ms * 1e-3 * kRecordedGoodHz / config_.nominal_rate_hz;
}

double LinkModel::DrawOutage(double interval_s) {
  if (random_.Uniform() >= kOutagesPerSecond * interval_s) return 0;
  const double length_s = -kOutageMeanS * std::log1p(-random_.Uniform());
  return std::clamp(length_s, kOutageMinS, kOutageMaxS);
}

LinkModel::Arrival LinkModel::Next() {
  const double period_s = 1 / config_.sensor_rate_hz;
  if (config_.quality == LinkQuality::kIdeal) {
    ++count_;
    const double at_s = static_cast<double>(count_) * period_s;
    const std::int64_t at_ns = start_ns_ + RoundToNanoseconds(at_s);
    return {at_ns, at_ns};
  }
  if (config_.queues) return NextQueued();
  double interval_s = DrawInterval();
  if (config_.quality == LinkQuality::kPoor) interval_s += DrawOutage(interval_s);
  last_ns_ += RoundToNanoseconds(interval_s);
  const double since_s = NanosecondsToSeconds(last_ns_ - start_ns_);
  const std::int64_t held_ns = RoundToNanoseconds(std::floor(since_s / period_s) * period_s);
  return {last_ns_, std::min(last_ns_, start_ns_ + held_ns)};
}

LinkModel::Arrival LinkModel::NextQueued() {
  std::int64_t made_ns = 0;
  do {
    ++count_;
    made_ns = start_ns_ + RoundToNanoseconds(static_cast<double>(count_) / config_.sensor_rate_hz);
    while (last_ns_ < made_ns) {
      const double interval_s = DrawInterval();
      const double outage_s = config_.quality == LinkQuality::kPoor ? DrawOutage(interval_s) : 0;
      last_ns_ += RoundToNanoseconds(interval_s + outage_s);
      if (outage_s > 0) lost_until_ns_ = last_ns_ - RoundToNanoseconds(interval_s);
    }
  } while (made_ns < lost_until_ns_);
  constexpr std::int64_t kTogetherNs = 1'000;  // Later reports of one turn.
  return {std::exchange(last_ns_, last_ns_ + kTogetherNs), made_ns};
}

}  // namespace footing::virtual_devices
