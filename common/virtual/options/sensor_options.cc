#include "common/virtual/options/sensor_options.h"

namespace footing::sensor_options {

void AddMotionFile(CLI::App& command, std::string& skeleton, std::optional<double>& bvh_unit_m) {
  command.add_option("--skeleton", skeleton, "Skeleton of an AMC motion, ASF file");
  command
      .add_option("--bvh-unit-m", bvh_unit_m,
                  "Unit of length of a BVH motion, m (default: by the height of its person)")
      ->check(CLI::Range(1e-4, 10.0));
}

void AddCellErrors(CLI::App& command, double& noise_kg, double& gain_spread) {
  command
      .add_option("--cell-noise-kg", noise_kg, "Standard deviation of the noise of a sensor, kg")
      ->check(CLI::Range(0.0, 5.0));
  command
      .add_option("--gain-error", gain_spread,
                  "Standard deviation of the relative gain error of a sensor; 0.01 is one percent")
      ->check(CLI::Range(0.0, 0.2));
}

void AddBoardErrors(CLI::App& command, virtual_sensors::CellErrorConfig& errors) {
  AddCellErrors(command, errors.noise_kg, errors.gain_spread);
  command
      .add_option("--slow-force-n", errors.slow_force_n, "Slowly varying force error of a board, N")
      ->check(CLI::Range(0.0, 50.0));
  command
      .add_option("--hysteresis-n", errors.hysteresis_n, "Half width of a sensor's hysteresis, N")
      ->check(CLI::Range(0.0, 50.0));
}

std::vector<CLI::Option*> AddUserStyle(CLI::App& command, users::StyleWish& style) {
  auto* tempo =
      command.add_option("--tempo", style.tempo,
                         "Frequencies as a share of ordinary ones (default: drawn, 0.94 to 1.06)");
  auto* amplitude = command.add_option(
      "--amplitude", style.amplitude,
      "Size of the motions, as a share of ordinary ones (default: drawn, 0.85 to 1.2)");
  auto* asymmetry = command.add_option(
      "--asymmetry", style.asymmetry,
      "Share by which the left side moves more than the mean (default: drawn, -0.1 to 0.1)");
  return {tempo->check(CLI::Range(0.3, 2.0)), amplitude->check(CLI::Range(0.2, 2.0)),
          asymmetry->check(CLI::Range(-0.5, 0.5))};
}

}  // namespace footing::sensor_options
