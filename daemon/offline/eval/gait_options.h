#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

namespace footing::eval {

/// Of footing-eval gait.
struct GaitOptions {
  std::string gait = "walk";
  double speed_mps = 0;
  std::optional<double> height_m;
  double turn_deg = 0;
  double seconds = 60;
  int trials = 1;
  std::string seed = "1";
  double push_ns = 2;
  std::optional<double> push_direction_deg;
  double push_phase = -1;
  double slope_deg = 0;
  double step_m = 0;
  int push_directions = 0;
  int push_phases = 12;
  std::optional<double> pit_m;
  double jump_lead_s = 0.8;
  bool no_jump = false;
};

/// Adds the options to the subcommand. `options` must outlive the parsing.
void AddOptions(CLI::App& command, GaitOptions& options);

}  // namespace footing::eval
