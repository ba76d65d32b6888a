#include "daemon/offline/eval/features_command.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/cli/cli.h"
#include "common/base/json_text.h"
#include "common/base/time.h"
#include "common/base/units.h"
#include "daemon/offline/analysis/features_chain.h"
#include "daemon/offline/eval/accuracy.h"
#include "daemon/offline/eval/delays.h"
#include "daemon/offline/eval/features_input.h"
#include "daemon/offline/eval/mounting_trials.h"

namespace footing::eval {
namespace {

constexpr double kRowHz = 50;
/// A GRT file names no rate. Its shakes repeat every 11 to 15 rows; a hand that shakes at 3.4
/// to 4.5 Hz makes that 50 rows a second, the 100 of the Wiimote would be 7 to 9 Hz.
constexpr double kGrtRateHz = 50;

struct Options {
  std::string left;
  std::string right;
  std::string grt;
  double rate_hz = 0;
  double range_mps2 = 0;
  bool synthetic = false;
  bool delays = false;
  int mounting_trials = 0;
  std::string standing;
  std::string walking;
  int trials = 200;
  std::uint64_t seed = 1;
};

nlohmann::json Row(double t_s, const stream::RigFeatures& rig) {
  const auto& left = rig.devices.front();
  const auto moving = std::any_of(rig.devices.begin(), rig.devices.end(),
                                  [](const auto& device) { return device.moving; });
  // One hand's numbers stand for both; the right one speaks where the left one has none.
  const auto& speaker =
      !left.frequency_valid && rig.devices.back().frequency_valid ? rig.devices.back() : left;
  const auto or_null = [](bool valid, double value) {
    return valid ? nlohmann::json(value) : nlohmann::json(nullptr);
  };
  const bool phase_valid = !rig.pairs.empty() && rig.pairs.front().phase_valid;
  return {{"t_s", t_s},
          {"moving", moving},
          {"frequency_hz", or_null(speaker.frequency_valid, speaker.frequency_hz)},
          {"phase_rad", or_null(phase_valid, phase_valid ? rig.pairs.front().phase_rad : 0.0)},
          {"amplitude_mps2", or_null(speaker.amplitude_valid, speaker.amplitude_mps2)},
          {"roll_rad", or_null(speaker.inclination_valid, speaker.roll_rad)},
          {"pitch_rad", or_null(speaker.inclination_valid, speaker.pitch_rad)},
          {"held", speaker.held}};
}

/// When a row is due: rows run at 50 Hz whatever the rate of the samples.
class RowClock {
 public:
  bool Due(double t_s) {
    if (t_s + 1e-9 < static_cast<double>(rows_) / kRowHz) return false;
    rows_ = static_cast<std::int64_t>(std::floor(t_s * kRowHz + 1e-6)) + 1;
    return true;
  }

 private:
  std::int64_t rows_ = 0;
};

Result<nlohmann::json> EvaluateCsv(const Options& options) {
  if (options.rate_hz <= 0) return UsageError("--left needs --rate-hz, the rows a second");
  const auto left = ReadAccelerationCsv(options.left);
  if (!left) return left.error();
  std::optional<std::vector<Eigen::Vector3d>> right;
  if (!options.right.empty()) {
    auto rows = ReadAccelerationCsv(options.right);
    if (!rows) return rows.error();
    right = std::move(rows).value();
  }
  const auto left_clipped = ClippedAxes(*left, options.range_mps2);
  const auto right_clipped =
      right ? ClippedAxes(*right, options.range_mps2) : std::vector<std::uint32_t>{};
  const std::size_t count = right ? std::min(left->size(), right->size()) : left->size();
  Chain chain(right.has_value());
  RowClock clock;
  auto rows = nlohmann::json::array();
  for (std::size_t i = 0; i < count; ++i) {
    const double t_s = static_cast<double>(i) / options.rate_hz;
    const auto now_ns = RoundToNanoseconds(t_s);
    chain.Add(kLeftDevice, now_ns, (*left)[i], left_clipped[i]);
    if (right) chain.Add(kRightDevice, now_ns, (*right)[i], right_clipped[i]);
    const auto features = chain.Compute(now_ns);
    if (clock.Due(t_s)) rows.push_back(Row(t_s, features));
  }
  return nlohmann::json{{"samples", count}, {"rate_hz", options.rate_hz}, {"rows", rows}};
}

Result<nlohmann::json> EvaluateGrt(const Options& options) {
  const auto recording = ReadGrt(options.grt);
  if (!recording) return recording.error();
  const double rate_hz = options.rate_hz > 0 ? options.rate_hz : kGrtRateHz;
  std::optional<Chain> chain;
  int stretch = 0;
  std::size_t moving = 0;
  RowClock clock;
  auto rows = nlohmann::json::array();
  for (std::size_t i = 0; i < recording->rows.size(); ++i) {
    const auto& row = recording->rows[i];
    // Stretches were recorded one by one; what follows another starts again.
    if (!chain || row.stretch != stretch) chain.emplace(false);
    stretch = row.stretch;
    const double t_s = static_cast<double>(i) / rate_hz;
    const auto now_ns = RoundToNanoseconds(t_s);
    chain->Add(kLeftDevice, now_ns, row.specific_force_mps2);
    const auto features = chain->Compute(now_ns);
    moving += features.devices.front().moving ? 1 : 0;
    if (clock.Due(t_s)) rows.push_back(Row(t_s, features));
  }
  const auto samples = recording->rows.size();
  return nlohmann::json{
      {"samples", samples},
      {"rate_hz", rate_hz},
      {"rate_note", options.rate_hz > 0
                        ? "given on the command line"
                        : "assumed: the file names no rate; --rate-hz overrides it"},
      {"mps2_per_unit", recording->mps2_per_unit},
      {"scale_note", "assumed: 0.5 is 0; fitted so that the median of the quieter half is 1 g"},
      {"moving_fraction", static_cast<double>(moving) / static_cast<double>(samples)},
      {"rows", rows}};
}

Result<nlohmann::json> EvaluateMounting(const Options& options) {
  if (options.standing.empty() != options.walking.empty()) {
    return UsageError("--standing and --walking belong together");
  }
  if (options.standing.empty()) {
    return MeasureMounting(SyntheticWalk(), options.mounting_trials, options.seed);
  }
  const auto walk = RecordedWalk(options.standing, options.walking);
  if (!walk) return walk.error();
  return MeasureMounting(*walk, options.mounting_trials, options.seed);
}

Result<nlohmann::json> Evaluate(const Options& options) {
  const int inputs = (options.left.empty() ? 0 : 1) + (options.grt.empty() ? 0 : 1) +
                     (options.synthetic ? 1 : 0) + (options.delays ? 1 : 0) +
                     (options.mounting_trials > 0 ? 1 : 0);
  if (inputs != 1) {
    return UsageError(
        "features needs exactly one of --left, --grt, --synthetic, --delays and "
        "--mounting-trials");
  }
  if (options.mounting_trials > 0) return EvaluateMounting(options);
  if (options.synthetic) return MeasureAccuracy(options.trials, options.seed);
  if (options.delays) return MeasureDelays(options.trials, options.seed);
  return options.grt.empty() ? EvaluateCsv(options) : EvaluateGrt(options);
}

}  // namespace

void AddFeaturesCommand(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "features", "Features of accelerations: moving, frequency, phase, amplitude, inclination");
  command->add_option("--left", options->left,
                      "Accelerations of the left hand, CSV ax,ay,az in m/s2, sensor frame");
  command->add_option("--right", options->right,
                      "Accelerations of the right hand, same rows as --left");
  command->add_option("--rate-hz", options->rate_hz, "Sample rate of the CSV files, Hz")
      ->check(CLI::Range(10.0, 1000.0));
  command
      ->add_option("--range-mps2", options->range_mps2,
                   "Full-scale range of the sensor, m/s2 (default: detected in the file)")
      ->check(CLI::Range(1.0, 200.0));
  command->add_option("--grt", options->grt,
                      "Recording of the Gesture Recognition Toolkit in place of --left");
  command->add_flag("--synthetic", options->synthetic,
                    "Feature errors on synthetic motion, with their limits");
  command->add_flag("--delays", options->delays,
                    "Feature delays after synthetic changes, with their limits");
  command
      ->add_option(
          "--mounting-trials", options->mounting_trials,
          "Number of walks with randomly rotated sensors, compared with a perfect mounting")
      ->check(CLI::Range(1, 100000));
  command->add_option(
      "--standing", options->standing,
      "Marker file of the person standing, TRC; with --walking it replaces the synthetic walk");
  command->add_option("--walking", options->walking,
                      "Marker file of the same person walking one stride or more, TRC");
  command->add_option("--trials", options->trials, "Number of synthetic motions in each table row")
      ->check(CLI::Range(1, 100000));
  command->add_option("--seed", options->seed, "Seed of the synthetic motions");
  command->callback([options, &shared] {
    const auto result = Evaluate(*options);
    if (!result) {
      shared.exit_code = cli::Report(result.error());
      return;
    }
    std::cout << text::ToText(*result, shared.json ? -1 : 2) << std::endl;
  });
}

}  // namespace footing::eval
