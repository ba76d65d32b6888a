#include "daemon/offline/eval/clock.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/units.h"
#include "common/virtual/devices/link_model.h"
#include "common/virtual/devices/noise.h"
#include "daemon/offline/eval/report.h"
#include "daemon/sensor/reports/device_clock.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;
using virtual_devices::LinkModel;

/// Time before the scored part: the clock still looks for the sensor's ticks.
constexpr double kSettleS = 5;

struct ClockOptions {
  std::string link = "good";
  double rate_hz = 100;
  double sensor_rate_hz = 0;  ///< 0: as the reports.
  double clock_error_ppm = 0;
  double loss = 0;
  double seconds = 120;
  std::uint64_t seed = 1;
};

struct Course {
  std::vector<double> error_ms;  ///< Estimate less truth, once settled.
  std::uint64_t reports = 0;
  std::uint64_t lost = 0;
  std::uint64_t repeats = 0;
  bool monotonic = true;
};

Course Follow(const ClockOptions& options) {
  const double sensor_rate_hz =
      options.sensor_rate_hz > 0 ? options.sensor_rate_hz : options.rate_hz;
  link::DeviceClockConfig config;
  config.nominal_period_s = 1 / options.rate_hz;
  config.sensor_period_s = 1 / sensor_rate_hz;
  link::DeviceClock clock(config);
  LinkModel link(
      {virtual_devices::LinkNamed(options.link).value(),
       sensor_rate_hz * (1 + options.clock_error_ppm * 1e-6), options.rate_hz, options.seed},
      0);
  noise::Random random(options.seed + 1);
  Course course;
  std::int64_t held_ns = -1;
  std::int64_t before_ns = 0;
  const auto end_ns = SecondsToNanoseconds(options.seconds);
  for (auto arrival = link.Next(); arrival.arrives_ns < end_ns; arrival = link.Next()) {
    if (random.Uniform() < options.loss) {
      ++course.lost;
      continue;
    }
    ++course.reports;
    const bool changed = arrival.sampled_ns != held_ns;
    course.repeats += changed ? 0 : 1;
    held_ns = arrival.sampled_ns;
    const std::int64_t sampled_ns = clock.Advance(arrival.arrives_ns, changed);
    course.monotonic = course.monotonic && sampled_ns >= before_ns;
    before_ns = sampled_ns;
    if (NanosecondsToSeconds(arrival.arrives_ns) < kSettleS) continue;
    course.error_ms.push_back(NanosecondsToMilliseconds(sampled_ns - arrival.sampled_ns));
  }
  return course;
}

/// Quantile of sorted values, which are not empty.
double AtShare(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  return sorted[static_cast<std::size_t>(std::lround(at))];
}

Result<ordered_json> Evaluate(const ClockOptions& options) {
  Course course = Follow(options);
  if (course.error_ms.empty()) {
    return InvalidData("no report came after the first " + std::to_string(kSettleS).substr(0, 1) +
                       " s; make --seconds longer or --loss smaller");
  }
  std::vector<double>& error_ms = course.error_ms;
  std::sort(error_ms.begin(), error_ms.end());
  const double median_ms = AtShare(error_ms, 0.5);
  double square = 0;
  for (double& one : error_ms) {
    one = std::abs(one - median_ms);
    square += one * one;
  }
  std::sort(error_ms.begin(), error_ms.end());
  ordered_json out;
  out["link"] = options.link;
  out["rms_ms"] = std::sqrt(square / static_cast<double>(error_ms.size()));
  out["p99_ms"] = AtShare(error_ms, 0.99);
  out["max_ms"] = error_ms.back();
  out["median_removed_ms"] = median_ms;
  out["settle_s"] = kSettleS;
  out["measured"] = error_ms.size();
  out["reports"] = course.reports;
  out["lost"] = course.lost;
  out["repeats"] = course.repeats;
  out["monotonic"] = course.monotonic;
  return out;
}

}  // namespace

void AddClockCommand(CLI::App& app, Shared& shared) {
  auto* command = app.add_subcommand(
      "clock",
      "Error of sampled_ns against the true device clock, over a simulated Bluetooth link");
  const auto options = std::make_shared<ClockOptions>();
  command->add_option("--link", options->link, "Link model: ideal, good or poor")
      ->check(CLI::IsMember({"ideal", "good", "poor"}))
      ->capture_default_str();
  command->add_option("--rate-hz", options->rate_hz, "Report rate of a good link, Hz")
      ->check(CLI::Range(10.0, 1000.0))
      ->capture_default_str();
  command
      ->add_option("--sensor-rate-hz", options->sensor_rate_hz,
                   "Rate of new samples, Hz; 60 for a board (default: the report rate)")
      ->check(CLI::Range(10.0, 1000.0));
  command
      ->add_option("--clock-error-ppm", options->clock_error_ppm,
                   "Rate error of the device clock, ppm; positive when fast")
      ->check(CLI::Range(-50000.0, 50000.0))
      ->capture_default_str();
  command->add_option("--loss", options->loss, "Additional share of lost reports, 0 to 0.9")
      ->check(CLI::Range(0.0, 0.9))
      ->capture_default_str();
  command->add_option("--seconds", options->seconds, "Duration, s")
      ->check(CLI::Range(6.0, 86400.0))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "Seed of the link model")->capture_default_str();
  command->callback(
      [options, &shared] { shared.exit_code = PrintResult(Evaluate(*options), shared.json); });
}

}  // namespace footing::eval
