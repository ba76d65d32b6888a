#include "daemon/offline/eval/attitude_command.h"

#include <memory>

#include "daemon/offline/eval/attitude_trial.h"
#include "daemon/offline/eval/print_report.h"

namespace footing::eval {
namespace {

struct Flags {
  std::string imu, degrade = "none";
  std::uint64_t seed = 1;
  bool no_rows = false, no_rest_bias = false, no_motion_bias = false, no_gain = false;
  AttitudeTrialOptions options;
};

Result<nlohmann::ordered_json> Evaluate(Flags flags) {
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
  const auto flags = std::make_shared<Flags>();
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
