#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/virtual/devices/board_cells.h"
#include "common/virtual/people/style.h"

/// Options of the programs that simulate people, and load cells under a motion. What they set must
/// outlive the parsing.
namespace footing::sensor_options {

/// Facts that a motion file does not state: --skeleton of an AMC, --bvh-unit-m of a BVH.
void AddMotionFile(CLI::App& command, std::string& skeleton, std::optional<double>& bvh_unit_m);
/// --cell-noise-kg and --gain-error, of any cell.
void AddCellErrors(CLI::App& command, double& noise_kg, double& gain_spread);
/// The same with --slow-force-n and --hysteresis-n, of the cells of a board.
void AddBoardErrors(CLI::App& command, virtual_sensors::CellErrorConfig& errors);
/// --tempo, --amplitude and --asymmetry of a synthetic user; returns these options.
std::vector<CLI::Option*> AddUserStyle(CLI::App& command, users::StyleWish& style);

}  // namespace footing::sensor_options
