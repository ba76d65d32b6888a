#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "common/virtual/sensors/board_cells.h"

/// Options of the programs that simulate load cells under a motion. What they set must outlive the
/// parsing.
namespace footing::sensor_options {

/// What a motion file does not say: --skeleton of an AMC, --bvh-unit-m of a BVH.
void AddMotionFile(CLI::App& command, std::string& skeleton, std::optional<double>& bvh_unit_m);
/// --cell-noise-kg and --gain-error, of any cell.
void AddCellErrors(CLI::App& command, double& noise_kg, double& gain_spread);
/// The same with --slow-force-n and --hysteresis-n, of the cells of a board.
void AddBoardErrors(CLI::App& command, virtual_sensors::CellErrorConfig& errors);

}  // namespace footing::sensor_options
