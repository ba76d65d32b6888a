#include "daemon/offline/eval/attitude.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/virtual/devices/noise.h"
#include "daemon/offline/eval/report.h"

namespace footing::eval {
namespace {

constexpr double kWiimoteRateHz = 95;

/// The numbers of one row; nothing where a cell is empty.
std::optional<Eigen::Vector3d> ToVector(const std::vector<std::string>& cells, std::size_t first) {
  Eigen::Vector3d v;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto number = text::ToNumber(cells[first + i]);
    if (!number) return std::nullopt;
    v[static_cast<Eigen::Index>(i)] = *number;
  }
  return v;
}

Result<ImuSample> ToSample(const std::vector<std::string>& cells, bool has_truth, bool has_moving) {
  ImuSample sample;
  const auto turn = ToVector(cells, 0), force = ToVector(cells, 3);
  if (!turn || !force) return InvalidData("a reading is not a number");
  sample.reading = {.specific_force_S_mps2 = *force, .angular_velocity_S_radps = *turn};
  if (has_truth && !cells[6].empty()) {
    const auto w = text::ToNumber(cells[6]);
    const auto v = ToVector(cells, 7);
    const auto q =
        w && v ? Eigen::Quaterniond(*w, v->x(), v->y(), v->z()) : Eigen::Quaterniond(0, 0, 0, 0);
    if (std::abs(q.norm() - 1) > 0.01) return InvalidData("the quaternion does not have length 1");
    sample.truth = q.normalized();
  }
  if (has_moving) sample.scored = cells.back() == "1";
  return sample;
}

}  // namespace

Result<std::vector<ImuSample>> ReadImu(const std::string& path) {
  std::vector<std::string> columns{"gx", "gy", "gz", "ax", "ay", "az"};
  const auto header = ReadHeader(path);
  const auto has = [&header](const char* name) {
    return std::find(header.begin(), header.end(), name) != header.end();
  };
  const bool has_truth = has("qw"), has_moving = has("moving");
  if (has_truth) columns.insert(columns.end(), {"qw", "qx", "qy", "qz"});
  if (has_moving) columns.emplace_back("moving");
  const auto rows = ReadNamedColumns(path, columns);
  if (!rows) return rows.error();
  std::vector<ImuSample> samples;
  for (std::size_t i = 0; i < rows->size(); ++i) {
    const auto sample = ToSample((*rows)[i], has_truth, has_moving);
    if (!sample) {
      return InvalidData(path + ": row " + std::to_string(i + 1) + ": " + sample.error().message);
    }
    samples.push_back(*sample);
  }
  if (samples.size() < 2) return InvalidData(path + ": has fewer than two samples");
  return samples;
}

std::vector<ImuSample> AsWiimote(const std::vector<ImuSample>& samples, std::uint64_t seed,
                                 double& rate_hz) {
  const auto every = std::max<std::size_t>(1, static_cast<std::size_t>(rate_hz / kWiimoteRateHz));
  rate_hz /= static_cast<double>(every);
  const double slow = DegreesToRadians(595.0 / 8192), fast = 4.5 * slow;
  const double slow_range = DegreesToRadians(430);
  const double count_mps2 = kStandardGravityMps2 / 104, range_mps2 = 3.6 * kStandardGravityMps2;
  const Eigen::Vector3d bias = DegreesToRadians(1) * Eigen::Vector3d(0.4, -0.3, 0.25);
  noise::Random random(seed);
  std::vector<ImuSample> degraded;
  for (std::size_t i = 0; i < samples.size(); i += every) {
    ImuSample sample = samples[i];
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      double& turn = sample.reading.angular_velocity_S_radps[axis];
      turn += bias[axis] + DegreesToRadians(0.35) * random.Normal();
      const double count = std::abs(turn) > slow_range ? fast : slow;
      turn = count * std::round(turn / count);
      double& force = sample.reading.specific_force_S_mps2[axis];
      force += 0.06 * random.Normal();
      sample.reading.clipped = sample.reading.clipped || std::abs(force) >= range_mps2;
      force = count_mps2 * std::round(std::clamp(force, -range_mps2, range_mps2) / count_mps2);
    }
    degraded.push_back(sample);
  }
  return degraded;
}

namespace {

using nlohmann::ordered_json;

// How well the mean rate of a rest gives a bias: VQF's figure for a rest.
constexpr double kStillBiasSd = DegreesToRadians(0.03);

double MeanSquare(double sum, std::size_t count) {
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

/// Errors of the attitude in W, split into inclination and heading (Laidig et al. 2021, section 4).
class Score {
 public:
  void Add(const Eigen::Matrix3d& R_WS, const Eigen::Quaterniond& truth, double heading_sd_rad,
           double inclination_sd_rad) {
    const Eigen::Quaterniond error = Eigen::Quaterniond(R_WS) * truth.conjugate();
    const double inclination = 2 * std::acos(std::min(1.0, std::hypot(error.w(), error.z())));
    const double heading = 2 * std::atan2(error.z(), error.w());
    if (count_ == 0) {
      first_heading_ = heading;
      first_variance_ = heading_sd_rad * heading_sd_rad;
    }
    const double off = WrapAngle(heading - first_heading_);
    const double variance = heading_sd_rad * heading_sd_rad - first_variance_;
    ++count_;
    squares_ += inclination * inclination;
    most_ = std::max(most_, inclination);
    heading_squares_ += off * off;
    heading_most_ = std::max(heading_most_, std::abs(off));
    last_heading_ = off;
    last_sd_ = std::sqrt(std::max(0.0, variance));
    inclination_ratio_ += inclination * inclination / (2 * inclination_sd_rad * inclination_sd_rad);
  }

  ordered_json Json() const {
    return {{"scored", count_},
            {"inclination_rmse_deg", RadiansToDegrees(std::sqrt(MeanSquare(squares_, count_)))},
            {"inclination_max_deg", RadiansToDegrees(most_)},
            {"inclination_nees", MeanSquare(inclination_ratio_, count_)},
            {"heading_rmse_deg", RadiansToDegrees(std::sqrt(MeanSquare(heading_squares_, count_)))},
            {"heading_max_deg", RadiansToDegrees(heading_most_)},
            {"heading_end_deg", RadiansToDegrees(last_heading_)},
            {"heading_end_sd_deg", RadiansToDegrees(last_sd_)}};
  }
  std::size_t count() const { return count_; }

 private:
  std::size_t count_ = 0;
  double squares_ = 0, most_ = 0, inclination_ratio_ = 0;
  double first_heading_ = 0, first_variance_ = 0, last_heading_ = 0, last_sd_ = 0;
  double heading_squares_ = 0, heading_most_ = 0;
};

void Start(const std::vector<ImuSample>& samples, const AttitudeTrialOptions& options,
           arms::AttitudeFilter& filter) {
  const auto count = std::clamp<std::size_t>(
      static_cast<std::size_t>(options.still_s * options.rate_hz), 1, samples.size());
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), turn = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    force += samples[i].reading.specific_force_S_mps2;
    turn += samples[i].reading.angular_velocity_S_radps;
  }
  if (force.norm() == 0) force = Eigen::Vector3d::UnitZ();
  filter.Start(force / static_cast<double>(count), turn / static_cast<double>(count), kStillBiasSd);
}

}  // namespace

ordered_json RunAttitudeTrial(const std::vector<ImuSample>& samples,
                              const AttitudeTrialOptions& options) {
  arms::AttitudeFilter filter(options.filter);
  Start(samples, options, filter);
  Score score;
  std::size_t clipped = 0;
  ordered_json rows = ordered_json::array();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    filter.Advance(samples[i].reading, 1 / options.rate_hz);
    clipped += samples[i].reading.clipped ? 1 : 0;
    const double heading_sd = filter.heading_sd_rad(), inclination_sd = filter.inclination_sd_rad();
    if (samples[i].truth && samples[i].scored)
      score.Add(filter.R_WS(), *samples[i].truth, heading_sd, inclination_sd);
    if (!options.rows) continue;
    const Eigen::Quaterniond q(filter.R_WS());
    rows.push_back({{"t_s", static_cast<double>(i) / options.rate_hz},
                    {"qw", q.w()},
                    {"qx", q.x()},
                    {"qy", q.y()},
                    {"qz", q.z()},
                    {"heading_sd_rad", heading_sd},
                    {"inclination_sd_rad", inclination_sd}});
  }
  ordered_json json = {{"samples", samples.size()},
                       {"rate_hz", options.rate_hz},
                       {"clipped_share", MeanSquare(static_cast<double>(clipped), samples.size())}};
  if (score.count() > 0) json.update(score.Json());
  if (options.rows) json["rows"] = std::move(rows);
  return json;
}

namespace {

struct AttitudeFlags {
  std::string imu, degrade = "none";
  std::uint64_t seed = 1;
  bool no_rows = false, no_rest_bias = false, no_motion_bias = false, no_gain = false;
  AttitudeTrialOptions options;
};

Result<nlohmann::ordered_json> Evaluate(AttitudeFlags flags) {
  auto samples = ReadImu(flags.imu);
  if (!samples) return samples.error();
  AttitudeTrialOptions& options = flags.options;
  if (flags.degrade == "wiimote") *samples = AsWiimote(*samples, flags.seed, options.rate_hz);
  options.rows = !flags.no_rows;
  options.filter.bias_in_rest = !flags.no_rest_bias;
  options.filter.bias_in_motion = !flags.no_motion_bias;
  options.filter.gain_in_motion = !flags.no_gain;
  return RunAttitudeTrial(*samples, options);
}

}  // namespace

void AddAttitudeCommand(CLI::App& app, Shared& shared) {
  auto* command = app.add_subcommand(
      "attitude",
      "Attitude from a gyroscope and an accelerometer, compared with the truth where it is known");
  const auto flags = std::make_shared<AttitudeFlags>();
  arms::AttitudeOptions& filter = flags->options.filter;
  command
      ->add_option(
          "--imu", flags->imu,
          "Recording, CSV gx,gy,gz (rad/s), ax,ay,az (m/s2), optional qw,qx,qy,qz,moving; it "
          "begins at rest. scripts/broad-csv writes it from a trial of BROAD")
      ->required();
  command->add_option("--rate-hz", flags->options.rate_hz, "Sample rate, Hz")
      ->required()
      ->check(CLI::Range(10.0, 10'000.0));
  command->add_option("--degrade", flags->degrade, "Sensors to degrade to: none or wiimote")
      ->check(CLI::IsMember({"none", "wiimote"}));
  command->add_option("--seed", flags->seed, "Seed of the degraded sensors' noise");
  command->add_option("--still-s", flags->options.still_s, "Duration of the rest at the start, s")
      ->check(CLI::Range(0.1, 60.0));
  command->add_option("--gravity-s", filter.gravity_s, "Time constant of the mean force, s")
      ->check(CLI::Range(0.1, 60.0));
  command
      ->add_option("--frozen-s", filter.frozen_s, "Duration without correction after clipping, s")
      ->check(CLI::Range(0.0, 60.0));
  command->add_flag("--no-rest-bias", flags->no_rest_bias, "Do not learn the bias at rest");
  command->add_flag("--no-motion-bias", flags->no_motion_bias, "Do not learn the bias in motion");
  command->add_flag("--no-gain", flags->no_gain, "Do not learn the gains of the gyroscope");
  command->add_flag("--no-rows", flags->no_rows, "Leave the rows out");
  command->callback(
      [flags, &shared] { shared.exit_code = PrintResult(Evaluate(*flags), shared.json); });
}

}  // namespace footing::eval
