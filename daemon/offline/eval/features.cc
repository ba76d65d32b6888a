#include "daemon/offline/eval/features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/json_text.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/cli/cli.h"
#include "common/runtime/files.h"
#include "daemon/offline/analysis/features_chain.h"
#include "daemon/offline/eval/mounting.h"

namespace footing::eval {
namespace {

constexpr double kRowHz = 50;
/// A GRT file names no rate. Its shakes repeat every 11 to 15 rows; a hand that shakes at 3.4
/// to 4.5 Hz makes that 50 rows a second, the 100 of the Wiimote would be 7 to 9 Hz.
constexpr double kGrtRateHz = 50;

struct FeatureOptions {
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
  bool decisions = false;
  std::string features = "best";
  int trials = 200;
  std::uint64_t seed = 1;
};

features::Config ConfigOf(const FeatureOptions& options) {
  return *features::Named(options.features);
}

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

Result<nlohmann::json> EvaluateCsv(const FeatureOptions& options) {
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
  Chain chain(right.has_value(), ConfigOf(options));
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

Result<nlohmann::json> EvaluateGrt(const FeatureOptions& options) {
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
    if (!chain || row.stretch != stretch) chain.emplace(false, ConfigOf(options));
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

Result<nlohmann::json> EvaluateMounting(const FeatureOptions& options) {
  if (options.standing.empty() != options.walking.empty()) {
    return UsageError("--standing and --walking belong together");
  }
  if (options.standing.empty()) {
    return MeasureMounting(SyntheticWalk(), options.mounting_trials, options.seed,
                           ConfigOf(options));
  }
  const auto walk = RecordedWalk(options.standing, options.walking);
  if (!walk) return walk.error();
  return MeasureMounting(*walk, options.mounting_trials, options.seed, ConfigOf(options));
}

Result<nlohmann::json> Evaluate(const FeatureOptions& options) {
  const int inputs = (options.left.empty() ? 0 : 1) + (options.grt.empty() ? 0 : 1) +
                     (options.synthetic ? 1 : 0) + (options.delays ? 1 : 0) +
                     (options.decisions ? 1 : 0) + (options.mounting_trials > 0 ? 1 : 0);
  if (inputs != 1) {
    return UsageError(
        "features needs exactly one of --left, --grt, --synthetic, --delays, --decisions and "
        "--mounting-trials");
  }
  const features::Config config = ConfigOf(options);
  if (options.mounting_trials > 0) return EvaluateMounting(options);
  if (options.synthetic) return MeasureAccuracy(options.trials, options.seed, config);
  if (options.delays) return MeasureDelays(options.trials, options.seed, config);
  if (options.decisions) return MeasureDecisions(options.trials, options.seed, config);
  return options.grt.empty() ? EvaluateCsv(options) : EvaluateGrt(options);
}

}  // namespace

void AddFeaturesCommand(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<FeatureOptions>();
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
  command->add_flag("--decisions", options->decisions,
                    "Gaits that the features of synthetic motion decide on, beside those meant");
  command
      ->add_option("--features", options->features,
                   "best, or paper: equations (3) and (4) of the gait paper as printed")
      ->check(CLI::IsMember({"best", "paper"}))
      ->capture_default_str();
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

namespace {

/// FeatureErrors of one feature.
struct FeatureErrors {
  std::vector<double> values;
  nlohmann::json Summary(double bar) const {
    const double p95 = text::Quantile(values, 0.95);
    return {{"p50", text::Median(values)},      {"p95", p95}, {"p99", text::Quantile(values, 0.99)},
            {"max", text::Quantile(values, 1)}, {"bar", bar}, {"met", p95 <= bar}};
  }
};

struct Totals {
  FeatureErrors frequency_hz;
  FeatureErrors phase_deg;
  FeatureErrors amplitude_share;  // In units of 5 % or one count, whichever is more.
  FeatureErrors inclination_deg;
  std::size_t ticks = 0;
  std::size_t missing = 0;
  std::size_t held = 0;
  std::size_t confused = 0;
};

struct Trial {
  wrists::Segment segment;
  wrists::Shape shape;
  wrists::SensorModel sensor;
  double start_angle_rad = 0;
};

Trial Draw(noise::Random& random, bool clip) {
  Trial trial;
  trial.segment.frequency_hz = random.Uniform(0.5, 4.5);
  trial.segment.phase_rad = random.Uniform(-kPi, kPi);
  trial.segment.amplitude_mps2 = clip ? random.Uniform(24, 40) : random.Uniform(4, 18);
  trial.segment.roll_rad = DegreesToRadians(random.Uniform(-25, 25));
  trial.segment.pitch_rad = DegreesToRadians(random.Uniform(-25, 25));
  trial.segment.duration_s = 3 + 5 / trial.segment.frequency_hz;
  if (random.Uniform() < 0.5) trial.shape = wrists::WristShape();
  const double tilt = random.Uniform(0, 2 * kPi);
  if (clip) trial.shape.direction_S = {0, std::cos(tilt), std::sin(tilt)};
  trial.start_angle_rad = random.Uniform(0, 2 * kPi);
  return trial;
}

void Count(const Trial& trial, const stream::RigFeatures& rig, Totals& totals) {
  const auto& truth = trial.segment;
  ++totals.ticks;
  for (const auto& device : rig.devices) {
    totals.held += device.held ? 1 : 0;
    if (!device.moving || !device.frequency_valid || !device.amplitude_valid ||
        !device.inclination_valid) {
      ++totals.missing;
      continue;
    }
    totals.frequency_hz.values.push_back(std::abs(device.frequency_hz - truth.frequency_hz));
    const double allowed = std::max(0.05 * truth.amplitude_mps2, trial.sensor.quantum_mps2);
    totals.amplitude_share.values.push_back(std::abs(device.amplitude_mps2 - truth.amplitude_mps2) /
                                            allowed);
    totals.inclination_deg.values.push_back(RadiansToDegrees(std::max(
        std::abs(device.roll_rad - truth.roll_rad), std::abs(device.pitch_rad - truth.pitch_rad))));
  }
  const auto& pair = rig.pairs.front();
  if (!pair.phase_valid) {
    ++totals.missing;
    return;
  }
  const double error_rad = std::abs(WrapAngle(pair.phase_rad - truth.phase_rad));
  totals.phase_deg.values.push_back(RadiansToDegrees(error_rad));
  totals.confused += error_rad > kPi / 2 ? 1 : 0;
}

nlohmann::json MeasureVariant(int trials, std::uint64_t seed, bool clip,
                              const features::Config& config) {
  noise::Random random(seed);
  Totals totals;
  for (int i = 0; i < trials; ++i) {
    const Trial trial = Draw(random, clip);
    const wrists::HandMotion motion({trial.segment}, trial.shape, 0, trial.start_angle_rad);
    const auto ticks =
        Run(Record(motion, trial.sensor, seed + static_cast<std::uint64_t>(i)), config);
    const double settled_s = 0.5 + 3 / trial.segment.frequency_hz;
    for (const Tick& tick : ticks) {
      if (tick.t_s >= settled_s) Count(trial, tick.features, totals);
    }
  }
  const double slack = clip ? 2 : 1;
  return {{"frequency_error_hz", totals.frequency_hz.Summary(0.03 * slack)},
          {"phase_error_deg", totals.phase_deg.Summary(5 * slack)},
          {"amplitude_error_of_allowed", totals.amplitude_share.Summary(slack)},
          {"inclination_error_deg", totals.inclination_deg.Summary(2 * slack)},
          {"in_and_out_of_phase_confused", totals.confused},
          {"ticks", totals.ticks},
          {"features_missing", totals.missing},
          {"features_held", totals.held}};
}

}  // namespace

nlohmann::json MeasureAccuracy(int trials, std::uint64_t seed, const features::Config& config) {
  return {{"trials", trials},
          {"seed", seed},
          {"conditions",
           "0.5 to 4.5 Hz, half sines and half wrist-like, any phase, roll and pitch within 25 "
           "degrees, 100 Hz, 38 mg counts, 3.1 mg noise; amplitude 4 to 18 m/s2, clipped 24 to 40 "
           "m/s2 in any direction of the y-z plane at +-3 g; every tick after 3 cycles and 0.5 s"},
          {"amplitude_allowed", "5 % or one count, whichever is more"},
          {"free", MeasureVariant(trials, seed, false, config)},
          {"clipped", MeasureVariant(trials, seed, true, config)}};
}

namespace {

constexpr std::size_t kMostSampleBytes = 256u << 20;
/// No controller measures more than this (about 20 g); a larger number is in another unit.
constexpr double kMostMps2 = 200;
constexpr double kGrtZero = 0.5;
/// Values that differ by less are the same count, written with three decimals.
constexpr double kSameMps2 = 1e-3;

/// All fields of a line as numbers, or nothing.
std::optional<std::vector<double>> Numbers(std::string line) {
  std::replace(line.begin(), line.end(), ',', ' ');
  std::istringstream fields(line);
  std::vector<double> numbers;
  for (std::string field; fields >> field;) {
    char* end = nullptr;
    numbers.push_back(std::strtod(field.c_str(), &end));
    if (*end != '\0') return std::nullopt;
  }
  return numbers;
}

bool IsBlank(const std::string& line) {
  return line.find_first_not_of(" \t\r") == std::string::npos;
}

std::string At(const std::string& path, std::size_t line) {
  return path + ", line " + std::to_string(line);
}

/// The end of the range on one side (sign +1 or -1) of an axis; infinite when nothing shows it.
double EndOfRange(const std::vector<Eigen::Vector3d>& rows, int axis, double sign) {
  double most = 0;
  for (const auto& row : rows) most = std::max(most, sign * row(axis));
  int run = 0;
  for (const auto& row : rows) {
    run = sign * row(axis) >= most - kSameMps2 ? run + 1 : 0;
    if (run == 3 && most > 2.9 * kStandardGravityMps2) return most - kSameMps2;
  }
  return INFINITY;
}

double FitScale(const GrtRecording& recording) {
  // How much a row differs from the one before; the quieter half are those at rest or nearly so.
  std::vector<std::pair<double, double>> change_and_length;
  for (std::size_t i = 1; i < recording.rows.size(); ++i) {
    const Eigen::Vector3d& here = recording.rows[i].specific_force_mps2;
    const Eigen::Vector3d& before = recording.rows[i - 1].specific_force_mps2;
    change_and_length.emplace_back((here - before).norm(), here.norm());
  }
  std::sort(change_and_length.begin(), change_and_length.end());
  change_and_length.resize(std::max<std::size_t>(1, change_and_length.size() / 2));
  std::vector<double> lengths;
  for (const auto& entry : change_and_length) lengths.push_back(entry.second);
  return kStandardGravityMps2 / std::max(1e-6, text::Median(std::move(lengths)));
}

}  // namespace

Result<std::vector<Eigen::Vector3d>> ReadAccelerationCsv(const std::string& path) {
  const Result<std::string> text = config::ReadTextFile(path, kMostSampleBytes);
  if (!text) return text.error();
  std::istringstream lines(*text);
  std::vector<Eigen::Vector3d> rows;
  std::size_t number = 0;
  bool first = true;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (IsBlank(line)) continue;
    const auto numbers = Numbers(line);
    const bool header = first && !numbers;
    first = false;
    if (header) continue;
    if (!numbers || numbers->size() != 3) {
      return InvalidData(At(path, number) + ": expected three numbers ax,ay,az in m/s2, found '" +
                         line.substr(0, 60) + "'");
    }
    const Eigen::Vector3d row((*numbers)[0], (*numbers)[1], (*numbers)[2]);
    if (!row.allFinite() || row.cwiseAbs().maxCoeff() > kMostMps2) {
      return InvalidData(At(path, number) + ": accelerations must be within +-200 m/s2, found '" +
                         line.substr(0, 60) + "'; convert from g or counts first");
    }
    rows.push_back(row);
  }
  if (rows.empty()) return InvalidData(path + ": no rows ax,ay,az in it");
  return rows;
}

std::vector<std::uint32_t> ClippedAxes(const std::vector<Eigen::Vector3d>& rows,
                                       double range_mps2) {
  std::vector<std::uint32_t> clipped(rows.size(), 0);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      const double end = range_mps2 > 0 ? range_mps2 : EndOfRange(rows, axis, sign);
      for (std::size_t i = 0; i < rows.size(); ++i) {
        if (sign * rows[i](axis) >= end) clipped[i] |= 1u << axis;
      }
    }
  }
  return clipped;
}

Result<GrtRecording> ReadGrt(const std::string& path) {
  const Result<std::string> text = config::ReadTextFile(path, kMostSampleBytes);
  if (!text) return text.error();
  std::istringstream lines(*text);
  GrtRecording recording;
  std::size_t number = 0;
  bool in_rows = false;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (!in_rows || IsBlank(line)) {
      in_rows = in_rows || line.rfind("LabelledTrainingData:", 0) == 0;
      continue;
    }
    const auto numbers = Numbers(line);
    if (!numbers || numbers->size() != 4) {
      return InvalidData(At(path, number) + ": expected a class and three numbers, found '" +
                         line.substr(0, 60) + "'");
    }
    const Eigen::Vector3d value((*numbers)[1], (*numbers)[2], (*numbers)[3]);
    if (!value.allFinite() || value.minCoeff() < 0 || value.maxCoeff() > 1) {
      return InvalidData(At(path, number) + ": values must be between 0 and 1, found '" +
                         line.substr(0, 60) + "'");
    }
    recording.rows.push_back(
        {static_cast<int>((*numbers)[0]), value - Eigen::Vector3d::Constant(kGrtZero)});
  }
  if (recording.rows.size() < 2) {
    return InvalidData(path + ": no rows after a line 'LabelledTrainingData:'; is it a GRT file?");
  }
  recording.mps2_per_unit = FitScale(recording);
  for (auto& row : recording.rows) row.specific_force_mps2 *= recording.mps2_per_unit;
  return recording;
}

namespace {

/// Tolerances of a correct estimate: a frequency within 5 %, a phase within 20 degrees.
constexpr double kFrequencyShare = 0.05;
constexpr double kPhaseRad = 20 * kPi / 180;

using Right = std::function<bool(const stream::RigFeatures&)>;

/// Time from `change_s` until the features are right and stay so; infinite if they never do.
double DelayOf(const std::vector<Tick>& ticks, double change_s, const Right& right) {
  double since_s = INFINITY;
  for (const Tick& tick : ticks) {
    if (tick.t_s < change_s) continue;
    if (!right(tick.features)) {
      since_s = INFINITY;
    } else if (std::isinf(since_s)) {
      since_s = tick.t_s;
    }
  }
  return since_s - change_s;
}

Right MovingIs(bool moving) {
  return [moving](const stream::RigFeatures& rig) {
    return std::all_of(rig.devices.begin(), rig.devices.end(),
                       [moving](const auto& device) { return device.moving == moving; });
  };
}

Right FrequencyIs(double frequency_hz) {
  return [frequency_hz](const stream::RigFeatures& rig) {
    return std::all_of(rig.devices.begin(), rig.devices.end(), [&](const auto& device) {
      return device.frequency_valid &&
             std::abs(device.frequency_hz - frequency_hz) <= kFrequencyShare * frequency_hz;
    });
  };
}

Right PhaseIs(double phase_rad) {
  return [phase_rad](const stream::RigFeatures& rig) {
    const auto& pair = rig.pairs.front();
    return pair.phase_valid && std::abs(WrapAngle(pair.phase_rad - phase_rad)) <= kPhaseRad;
  };
}

wrists::Segment Still() { return {}; }

wrists::Segment Swing(double frequency_hz, double phase_rad, double amplitude_mps2,
                      double duration_s) {
  return {duration_s, frequency_hz, phase_rad, amplitude_mps2, 0.1, -0.1};
}

/// A change from one stretch to another, and what must become right after it.
struct Change {
  wrists::Segment before;
  wrists::Segment after;
  double slower_hz = 1;
  Right right;
};
using DrawChange = std::function<Change(noise::Random&)>;

/// The delay of every trial with the frequency of its slower motion.
struct Sample {
  double delay_s = 0;
  double slower_hz = 1;
};

std::vector<Sample> RunTrials(int trials, std::uint64_t seed, const features::Config& config,
                              const DrawChange& draw) {
  noise::Random random(seed);
  std::vector<Sample> samples;
  for (int i = 0; i < trials; ++i) {
    const Change change = draw(random);
    const auto shape = random.Uniform() < 0.5 ? wrists::Shape() : wrists::WristShape();
    const wrists::HandMotion motion({change.before, change.after}, shape, 0,
                                    random.Uniform(0, 2 * kPi));
    const auto ticks = Run(Record(motion, {}, seed + static_cast<std::uint64_t>(i)), config);
    samples.push_back({DelayOf(ticks, change.before.duration_s, change.right), change.slower_hz});
  }
  return samples;
}

/// Median and maximum of a quantity of the samples.
std::pair<double, double> MedianAndMaximum(const std::vector<Sample>& samples,
                                           const std::function<double(const Sample&)>& quantity) {
  std::vector<double> values;
  for (const Sample& sample : samples) values.push_back(quantity(sample));
  std::sort(values.begin(), values.end());
  return {values[values.size() / 2], values.back()};
}

nlohmann::json Finite(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json("never");
}

/// A row whose every delay is bounded by `allowed_s` of its trial.
nlohmann::json SecondsRow(const std::vector<Sample>& samples, const char* bar,
                          const std::function<double(const Sample&)>& allowed_s) {
  const auto seconds = MedianAndMaximum(samples, [](const Sample& s) { return s.delay_s; });
  const auto share =
      MedianAndMaximum(samples, [&](const Sample& s) { return s.delay_s / allowed_s(s); });
  return {{"median_s", Finite(seconds.first)},
          {"max_s", Finite(seconds.second)},
          {"max_of_allowed", Finite(share.second)},
          {"worst_at_hz", std::max_element(samples.begin(), samples.end(),
                                           [&](const Sample& a, const Sample& b) {
                                             return a.delay_s / allowed_s(a) <
                                                    b.delay_s / allowed_s(b);
                                           })
                              ->slower_hz},
          {"bar", bar},
          {"met", share.second <= 1}};
}

/// A row in cycles of the slower motion.
nlohmann::json CyclesRow(const std::vector<Sample>& samples) {
  const auto cycles =
      MedianAndMaximum(samples, [](const Sample& s) { return s.delay_s * s.slower_hz; });
  const auto less =
      MedianAndMaximum(samples, [](const Sample& s) { return (s.delay_s - 0.1) * s.slower_hz; });
  return {{"median_cycles", Finite(cycles.first)},
          {"median_cycles_less_0.1_s", Finite(less.first)},
          {"max_cycles", Finite(cycles.second)},
          {"bar", "median 1.25 cycles + 0.1 s, max 2 cycles"},
          {"met", less.first <= 1.25 && cycles.second <= 2}};
}

double DrawFrequency(noise::Random& random) { return random.Uniform(0.5, 4.5); }
double DrawAmplitude(noise::Random& random) { return random.Uniform(4, 18); }

DrawChange FromStill(const std::function<Right(double frequency_hz)>& right) {
  return [right](noise::Random& random) {
    const double f = DrawFrequency(random);
    return Change{Still(), Swing(f, kPi, DrawAmplitude(random), 4 / f), f, right(f)};
  };
}

DrawChange ToStill() {
  return [](noise::Random& random) {
    const double f = DrawFrequency(random);
    const double swung_s = random.Uniform(4, 5) / f;
    wrists::Segment still = Still();
    still.duration_s = 1.5;
    still.roll_rad = 0.1;
    still.pitch_rad = -0.1;
    return Change{Swing(f, kPi, DrawAmplitude(random), swung_s), still, f, MovingIs(false)};
  };
}

DrawChange FrequencyJump(double from_hz, double to_hz) {
  return [from_hz, to_hz](noise::Random& random) {
    const double amplitude = DrawAmplitude(random);
    const double slower_hz = std::min(from_hz, to_hz);
    return Change{Swing(from_hz, kPi, amplitude, random.Uniform(4, 5) / from_hz),
                  Swing(to_hz, kPi, amplitude, 4 / slower_hz), slower_hz, FrequencyIs(to_hz)};
  };
}

DrawChange PhaseJump(double from_rad, double to_rad) {
  return [from_rad, to_rad](noise::Random& random) {
    const double f = DrawFrequency(random);
    const double amplitude = DrawAmplitude(random);
    return Change{Swing(f, from_rad, amplitude, random.Uniform(4, 5) / f),
                  Swing(f, to_rad, amplitude, 4 / f), f, PhaseIs(to_rad)};
  };
}

}  // namespace

nlohmann::json MeasureDelays(int trials, std::uint64_t seed, const features::Config& config) {
  const auto start_s = [](const Sample&) { return 0.3; };
  const auto stop_s = [](const Sample& s) { return s.slower_hz >= 1.5 ? 0.3 : 0.45 / s.slower_hz; };
  const auto run = [&](const DrawChange& draw) { return RunTrials(trials, seed, config, draw); };
  const auto moving = FromStill([](double) { return MovingIs(true); });
  const auto frequency = FromStill([](double f) { return FrequencyIs(f); });
  const auto phase = FromStill([](double) { return PhaseIs(kPi); });
  return {
      {"trials", trials},
      {"seed", seed},
      {"right", "and stays so: frequency of both hands within 5 %, phase within 20 degrees"},
      {"start_moving", SecondsRow(run(moving), "0.3 s", start_s)},
      {"stop_moving", SecondsRow(run(ToStill()), "0.3 s from 1.5 Hz up, else 0.45 / f", stop_s)},
      {"start_frequency", CyclesRow(run(frequency))},
      {"start_phase", CyclesRow(run(phase))},
      {"frequency_1_to_3_hz", CyclesRow(run(FrequencyJump(1, 3)))},
      {"frequency_3_to_1_hz", CyclesRow(run(FrequencyJump(3, 1)))},
      {"phase_out_to_in", CyclesRow(run(PhaseJump(kPi, 0)))},
      {"phase_in_to_out", CyclesRow(run(PhaseJump(0, kPi)))}};
}

namespace {

/// Gaits that two remotes ask for (Figure 9 of the gait paper); none: features are missing.
constexpr std::array kDecisions = {"step", "walk", "run", "jump", "none"};
constexpr std::size_t kUndecided = kDecisions.size() - 1;
using DecisionCounts =
    std::array<std::array<std::size_t, kDecisions.size()>, kUndecided>;  // Meant, found.
constexpr double kRunHz = 2;
constexpr double kStretchS = 4;
constexpr double kDecidedAfterS = 2.5;  // Two cycles of 0.8 Hz.

std::size_t GaitOf(const stream::RigFeatures& rig) {
  const auto count = [&rig](bool stream::DeviceFeatures::*flag) {
    return std::count_if(rig.devices.begin(), rig.devices.end(),
                         [flag](const auto& device) { return device.*flag; });
  };
  if (count(&stream::DeviceFeatures::moving) == 0) return 0;
  const stream::PairFeatures& pair = rig.pairs.front();
  if (!pair.phase_valid) return kUndecided;
  if (std::abs(pair.phase_rad) < kPi / 2) return 3;
  const auto shown = count(&stream::DeviceFeatures::frequency_valid);
  if (shown == 0) return kUndecided;
  double sum_hz = 0;  // The frequency of a device that shows none is 0.
  for (const auto& device : rig.devices) sum_hz += device.frequency_hz;
  return sum_hz / static_cast<double>(shown) < kRunHz ? 1 : 2;
}

/// A stretch of that gait, clear of the borders between the gaits.
wrists::Segment DrawGait(std::size_t gait, noise::Random& random) {
  wrists::Segment segment = Still();
  segment.duration_s = kStretchS;
  if (gait == 0) return segment;
  segment =
      Swing(gait == 2 ? random.Uniform(2.3, 4) : random.Uniform(0.8, 1.7),
            (gait == 3 ? 0 : kPi) + random.Uniform(-0.6, 0.6), DrawAmplitude(random), kStretchS);
  segment.roll_rad = DegreesToRadians(random.Uniform(-25, 25));
  segment.pitch_rad = DegreesToRadians(random.Uniform(-25, 25));
  return segment;
}

nlohmann::json DecisionSummary(const DecisionCounts& counts) {
  nlohmann::json table = nlohmann::json::object();
  double right = 0, none = 0, sum = 0;
  for (std::size_t meant = 0; meant < kUndecided; ++meant) {
    for (std::size_t found = 0; found <= kUndecided; ++found) {
      const std::size_t ticks = counts[meant][found];
      table[kDecisions[meant]][kDecisions[found]] = ticks;
      sum += static_cast<double>(ticks);
    }
    right += static_cast<double>(counts[meant][meant]);
    none += static_cast<double>(counts[meant][kUndecided]);
  }
  return {{"ticks_by_meant_and_found", table},
          {"right_share", right / sum},
          {"wrong_share", (sum - right - none) / sum},
          {"none_share", none / sum}};
}

}  // namespace

nlohmann::json MeasureDecisions(int trials, std::uint64_t seed, const features::Config& config) {
  DecisionCounts all{}, settled{};
  noise::Random random(seed);
  for (int i = 0; i < trials; ++i) {
    std::array<std::size_t, 2 * kUndecided> meant{};
    std::vector<wrists::Segment> script;
    for (std::size_t n = 0; n < meant.size(); ++n) {
      // Never the same twice in a row.
      const auto further = static_cast<std::size_t>(random.Uniform(1, kUndecided));
      meant[n] = n == 0 ? 0 : (meant[n - 1] + further) % kUndecided;
      script.push_back(DrawGait(meant[n], random));
    }
    const auto shape = random.Uniform() < 0.5 ? wrists::Shape() : wrists::WristShape();
    const wrists::HandMotion motion(script, shape, 0, random.Uniform(0, 2 * kPi));
    for (const Tick& tick : Run(Record(motion, {}, seed + static_cast<std::uint64_t>(i)), config)) {
      const auto n = std::min(meant.size() - 1, static_cast<std::size_t>(tick.t_s / kStretchS));
      const std::size_t found = GaitOf(tick.features);
      ++all[meant[n]][found];
      const double since_s = tick.t_s - static_cast<double>(n) * kStretchS;
      if (since_s >= kDecidedAfterS) ++settled[meant[n]][found];
    }
  }
  return {{"trials", trials},
          {"seed", seed},
          {"conditions",
           "8 stretches of 4 s: still, or walk 0.8 to 1.7 Hz, run 2.3 to 4 Hz and jump 0.8 to 1.7 "
           "Hz, phase within 0.6 rad of out and in, amplitude 4 to 18 m/s2, roll and pitch within "
           "25 degrees, half sines and half wrist-like"},
          {"all", DecisionSummary(all)},
          {"settled", DecisionSummary(settled)},
          {"settled_is", "from 2.5 s after a change on"}};
}

}  // namespace footing::eval
