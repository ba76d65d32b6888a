#include "common/virtual/sensor_options/sensor_options.h"

namespace footing::sensor_options {

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

}  // namespace footing::sensor_options
