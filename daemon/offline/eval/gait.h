#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "daemon/offline/eval/report.h"
#include "daemon/simulation/engine/engine.h"

namespace footing::eval {

/// `gait`: trials of one gait at one command, each kicked.
void AddGaitCommand(CLI::App& app, Shared& shared);

/// A force on the body that goes on.
struct TowOptions {
  double force_n = 0;
  double direction_deg = 0;
};

/// Options of footing-eval gait.
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
  double radius_m = 0;
  double jump_lead_s = 0.8;
  bool no_jump = false;
  terrain::Surface surface;
  TowOptions tow;
};

/// Adds the options to the subcommand. `options` must outlive the parsing.
void AddOptions(CLI::App& command, GaitOptions& options);

/// Root of a mean of squares, built up value by value.
struct RootMeanSquare {
  double sum = 0;
  std::uint64_t count = 0;

  void Add(double value);
  double value() const;
};

/// Heading of a body's x axis, rad.
double YawOf(const Eigen::Quaterniond& q);

/// Measures of settled locomotion.
///
/// Speed errors are those of the mean speed over successive seconds, since the speed within one
/// step rises and falls by nature. The apex is that of the COM over its height at lift-off.
class GaitStatistics {
 public:
  explicit GaitStatistics(double commanded_speed_mps) : commanded_mps_(commanded_speed_mps) {}

  void Add(const engine::EngineOutput& output, double step_s);

  double speed_mean_mps() const { return time_s_ > 0 ? distance_m_ / time_s_ : 0; }
  double speed_error_rms_mps() const { return speed_error_.value(); }
  double heading_error_rms_rad() const { return heading_error_.value(); }
  double aside_mean_mps() const { return time_s_ > 0 ? aside_m_ / time_s_ : 0; }
  double apex_height_m() const { return hops_ > 0 ? apex_sum_m_ / hops_ : 0; }

 private:
  void AddApex(const engine::EngineOutput& output);

  double commanded_mps_;
  double time_s_ = 0;
  double distance_m_ = 0;
  double aside_m_ = 0;  ///< To the left of the heading.
  double window_s_ = 0;
  double window_m_ = 0;
  RootMeanSquare speed_error_;
  RootMeanSquare heading_error_;
  bool in_flight_ = false;
  bool flight_known_ = false;  ///< This flight was seen from its lift-off.
  double lift_off_m_ = 0;
  double apex_m_ = 0;
  double apex_sum_m_ = 0;
  int hops_ = 0;
};

/// `monkey`: a random gait, speed, height and turn every 0.5 to 4 s.
void AddMonkeyCommand(CLI::App& app, Shared& shared);

/// `style`: how settled gaits move over speed (style.cc).
void AddStyleCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
