#include "daemon/offline/eval/cop_filter.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "common/base/number.h"
#include "common/virtual/motion/signal.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;

/// What posturography advises: at least 50 Hz, and a low-pass at 10 Hz (Ruhe A et al., The
/// test-retest reliability of centre of pressure measures in bipedal static task conditions, Gait &
/// Posture 32(4), 2010; Scoppa F et al., Clinical stabilometry standardization, Gait & Posture
/// 37(2), 2013).
constexpr double kUsualRateHz = 50;
constexpr double kUsualCutoffHz = 10;
/// Above this share of the rate the low-pass leaves the signal as it is (motion::LowPass).
constexpr double kHighestCutoffOfRate = 0.36;
constexpr double kLowestRateHz = 1;
constexpr double kLowestCutoffHz = 0.1;
constexpr double kHighestHz = 1000;
/// 55 hours at 100 Hz: a guard against times in another unit.
constexpr double kMostResampled = 2e7;

constexpr const char* kAsRecorded = "recorded";
constexpr const char* kNone = "none";

struct FrequencyOption {
  const char* name;
  const std::string& text;
  const char* off;  ///< The word for no such filter.
  double lowest_hz;
};

/// The option in Hz, 0 where it is off, or `usual_hz` where it is not given.
Result<double> FrequencyOf(const FrequencyOption& option, double usual_hz) {
  if (option.text.empty()) return usual_hz;
  if (option.text == option.off) return 0.0;
  const auto hz = text::ToNumber(option.text);
  if (hz && *hz >= option.lowest_hz && *hz <= kHighestHz) return *hz;
  return UsageError(std::string(option.name) + " " + option.text + ": give " +
                    text::Shortest(option.lowest_hz) + " to 1000 Hz, or " + option.off);
}

void LowPass(const CopFilter& filter, std::vector<posturography::CopSample>& stretch) {
  Eigen::MatrixXd signal(2, static_cast<Eigen::Index>(stretch.size()));
  for (std::size_t i = 0; i < stretch.size(); ++i) {
    signal.col(static_cast<Eigen::Index>(i)) << stretch[i].x_m, stretch[i].y_m;
  }
  signal = motion::LowPass(signal, filter.rate_hz, filter.cutoff_hz);
  for (std::size_t i = 0; i < stretch.size(); ++i) {
    stretch[i].x_m = signal(0, static_cast<Eigen::Index>(i));
    stretch[i].y_m = signal(1, static_cast<Eigen::Index>(i));
  }
}

}  // namespace

Result<CopFilter> CopFilterOf(const CopFilterOptions& words, bool corners) {
  const auto rate_hz = FrequencyOf({"--rate-hz", words.rate, kAsRecorded, kLowestRateHz},
                                   corners ? kUsualRateHz : 0);
  if (!rate_hz) return rate_hz.error();
  const double highest_hz = kHighestCutoffOfRate * *rate_hz;
  const double usual_hz = corners && kUsualCutoffHz <= highest_hz ? kUsualCutoffHz : 0;
  const auto cutoff_hz =
      FrequencyOf({"--cutoff-hz", words.cutoff, kNone, kLowestCutoffHz}, usual_hz);
  if (!cutoff_hz) return cutoff_hz.error();
  if (*cutoff_hz > 0 && *rate_hz <= 0) {
    return UsageError("--cutoff-hz needs an even rate: give --rate-hz HZ");
  }
  if (words.window_s > 0 && *rate_hz <= 0) {
    return UsageError("--window-s is the window of --rate-hz HZ: give one");
  }
  if (*cutoff_hz > highest_hz) {
    return UsageError("--cutoff-hz " + words.cutoff + " is above 0.36 of the rate of " +
                      std::to_string(std::lround(*rate_hz)) + " Hz: lower it, or raise --rate-hz");
  }
  return CopFilter{*rate_hz, *cutoff_hz, words.window_s};
}

double DurationS(const posturography::Stretches& stretches) {
  double duration_s = 0;
  for (const auto& stretch : stretches) {
    duration_s += stretch.back().time_s - stretch.front().time_s;
  }
  return duration_s;
}

Result<void> FilterCop(const CopFilter& filter, posturography::Stretches& stretches,
                       ordered_json& answer) {
  const double median_s = posturography::MedianInterval(stretches);
  answer["recorded_rate_hz"] = median_s > 0 ? 1 / median_s : 0.0;
  if (filter.rate_hz <= 0) {
    answer["filter"] = kNone;
    answer["rate_hz"] = nullptr;
    answer["cutoff_hz"] = nullptr;
    return {};
  }
  const double duration_s = DurationS(stretches);
  if (duration_s * filter.rate_hz > kMostResampled) {
    return InvalidData("the recording lasts " + std::to_string(duration_s) +
                       " s, too long for --rate-hz; is its time in seconds?");
  }
  const double window_s =
      filter.window_s > 0 ? filter.window_s : std::max(2 / filter.rate_hz, 2 * median_s);
  for (std::vector<posturography::CopSample>& stretch : stretches) {
    stretch = posturography::Resample(stretch, filter.rate_hz, window_s);
    if (filter.cutoff_hz > 0) LowPass(filter, stretch);
  }
  std::string name = "SWARII window average (Audiffren & Contal 2016)";
  if (filter.cutoff_hz > 0) name += ", then Butterworth low-pass of 4th order without lag";
  answer["filter"] = name;
  answer["filter_window_s"] = window_s;
  answer["rate_hz"] = filter.rate_hz;
  answer["cutoff_hz"] =
      filter.cutoff_hz > 0 ? ordered_json(filter.cutoff_hz) : ordered_json(nullptr);
  return {};
}

}  // namespace footing::eval
