#include "daemon/offline/eval/board/board_command.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "common/board/geometry.h"
#include "common/cli/cli.h"
#include "common/units/units.h"
#include "daemon/offline/eval/board/board_export.h"
#include "daemon/offline/eval/report/print_report.h"
#include "daemon/offline/eval/report/table.h"
#include "daemon/offline/posturography/board.h"
#include "daemon/offline/posturography/sway.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;
using posturography::Stretches;
using posturography::Sway;

/// 55 hours at 100 Hz: a guard against times in another unit.
constexpr double kMostResampled = 2e7;
/// More than anybody weighs, and less than a light adult's weight in newtons.
constexpr double kMostPersonKg = 300;

struct Options {
  std::string corners;
  std::string cop;
  std::string board;  ///< Of an export with several.
  double rate_hz = 0;
  double window_s = 0;
  posturography::BoardShape shape;
  double spacing_x_mm = board::kBalanceBoard.sensor_distance_x_m * 1e3;
  double spacing_y_mm = board::kBalanceBoard.sensor_distance_y_m * 1e3;
};

/// What there is to measure.
struct Input {
  ordered_json head;  ///< Fields of the answer that come before the measures.
  Stretches stretches;
};

Result<std::vector<posturography::CornerSample>> ReadSamples(const Options& options) {
  if (IsBoardExport(options.corners)) return ReadBoardExport(options.corners, options.board);
  if (!options.board.empty()) {
    return UsageError("--board chooses a board of footing-log's export; " + options.corners +
                      " holds one board");
  }
  const auto rows = ReadTimeTable(options.corners, "time_s,tl_kg,tr_kg,bl_kg,br_kg");
  if (!rows) return rows.error();
  std::vector<posturography::CornerSample> samples;
  samples.reserve(rows->size());
  for (const std::vector<double>& row : *rows) {
    samples.push_back({row[0],
                       {KilogramsToNewtons(row[1]), KilogramsToNewtons(row[2]),
                        KilogramsToNewtons(row[3]), KilogramsToNewtons(row[4])}});
  }
  return samples;
}

Result<Input> ReadCorners(const Options& options) {
  const auto read = ReadSamples(options);
  if (!read) return read.error();
  const std::vector<posturography::CornerSample>& samples = *read;
  posturography::BoardShape shape = options.shape;
  shape.geometry.sensor_distance_x_m = options.spacing_x_mm / 1000;
  shape.geometry.sensor_distance_y_m = options.spacing_y_mm / 1000;
  posturography::Standing standing = posturography::FindStanding(samples, shape);
  if (standing.weight_n <= 0) {
    return InvalidData(options.corners + ": no sample with a load above " +
                       std::to_string(NewtonsToKilograms(shape.least_body_weight_n)).substr(0, 4) +
                       " kg or more: nobody stood on the board");
  }
  if (NewtonsToKilograms(standing.weight_n) > kMostPersonKg) {
    return InvalidData(options.corners + ": the loads add up to " +
                       std::to_string(std::lround(NewtonsToKilograms(standing.weight_n))) +
                       " kg, more than a person weighs; are they in newtons?");
  }
  Input input;
  input.head["mass_kg"] = NewtonsToKilograms(standing.weight_n);
  input.head["mass_definition"] = "median of the totals of 5 kg and more";
  input.head["samples_read"] = samples.size();
  input.head["samples_without_cop"] = samples.size() - standing.samples;
  input.stretches = std::move(standing.stretches);
  return input;
}

Result<Input> ReadCop(const Options& options) {
  const auto rows = ReadTimeTable(options.cop, "time_s,x_mm,y_mm");
  if (!rows) return rows.error();
  std::vector<posturography::CopSample> samples;
  samples.reserve(rows->size());
  for (const std::vector<double>& row : *rows) {
    samples.push_back({row[0], row[1] / 1000, row[2] / 1000});
  }
  Input input;
  input.head["samples_read"] = samples.size();
  input.stretches = posturography::SplitAtGaps(samples);
  return input;
}

/// Resamples every stretch when asked to; says in the answer what was done.
Result<void> Filter(const Options& options, Input& input) {
  const double median_s = posturography::MedianInterval(input.stretches);
  input.head["stretches"] = input.stretches.size();
  input.head["recorded_rate_hz"] = median_s > 0 ? 1 / median_s : 0.0;
  if (options.rate_hz <= 0) {
    input.head["filter"] = "none";
    return {};
  }
  double duration_s = 0;
  for (const auto& stretch : input.stretches) {
    duration_s += stretch.back().time_s - stretch.front().time_s;
  }
  if (duration_s * options.rate_hz > kMostResampled) {
    return InvalidData("the recording lasts " + std::to_string(duration_s) +
                       " s, too long for --rate-hz; is its time in seconds?");
  }
  const double window_s =
      options.window_s > 0 ? options.window_s : std::max(2 / options.rate_hz, 2 * median_s);
  for (std::vector<posturography::CopSample>& stretch : input.stretches) {
    stretch = posturography::Resample(stretch, options.rate_hz, window_s);
  }
  input.head["filter"] = "SWARII window average (Audiffren & Contal 2016)";
  input.head["filter_window_s"] = window_s;
  input.head["rate_hz"] = options.rate_hz;
  return {};
}

void Append(const Sway& sway, ordered_json& out) {
  constexpr double kMm = 1e3;
  constexpr double kMm2 = 1e6;
  out["samples"] = sway.samples;
  out["duration_s"] = sway.duration_s;
  out["path_length_mm"] = sway.path_m * kMm;
  out["path_ml_mm"] = sway.path_x_m * kMm;
  out["path_ap_mm"] = sway.path_y_m * kMm;
  out["mean_velocity_mm_s"] = sway.mean_velocity_mps * kMm;
  out["mean_velocity_ml_mm_s"] = sway.mean_velocity_x_mps * kMm;
  out["mean_velocity_ap_mm_s"] = sway.mean_velocity_y_mps * kMm;
  out["rms_ml_mm"] = sway.rms_x_m * kMm;
  out["rms_ap_mm"] = sway.rms_y_m * kMm;
  out["rms_radial_mm"] = sway.rms_radial_m * kMm;
  out["mean_distance_mm"] = sway.mean_distance_m * kMm;
  out["range_ml_mm"] = sway.range_x_m * kMm;
  out["range_ap_mm"] = sway.range_y_m * kMm;
  out["ellipse95_area_mm2"] = sway.ellipse95_prediction_m2 * kMm2;
  out["ellipse95_definition"] = "F-based prediction ellipse (Schubert & Kirchner 2014)";
  out["prediction_ellipse95_F_mm2"] = sway.ellipse95_prediction_m2 * kMm2;
  out["ellipse95_area_chi2_mm2"] = sway.ellipse95_chi_square_m2 * kMm2;
  out["ellipse95_area_prieto_F3_mm2"] = sway.ellipse95_prieto_m2 * kMm2;
  out["axis_major_sd_mm"] = sway.ellipse_axis_major_sd_m * kMm;
  out["axis_minor_sd_mm"] = sway.ellipse_axis_minor_sd_m * kMm;
  out["axis_major_angle_deg"] = RadiansToDegrees(sway.ellipse_angle_rad);
  out["sway_area_mm2_s"] = sway.sway_area_rate_m2ps * kMm2;
  out["circle95_area_mm2"] = sway.circle95_m2 * kMm2;
  out["mean_frequency_hz"] = sway.mean_frequency_hz;
}

Result<ordered_json> Evaluate(const Options& options) {
  const bool corners = !options.corners.empty();
  Result<Input> input = corners ? ReadCorners(options) : ReadCop(options);
  if (!input) return input.error();
  if (const Result<void> filtered = Filter(options, *input); !filtered) return filtered.error();
  std::size_t samples = 0;
  double duration_s = 0;
  for (const auto& stretch : input->stretches) {
    samples += stretch.size();
    duration_s += stretch.back().time_s - stretch.front().time_s;
  }
  if (samples < 3 || duration_s <= 0) {
    return InvalidData((corners ? options.corners : options.cop) +
                       ": measures of sway need 3 samples of a COP over some time; it has " +
                       std::to_string(samples));
  }
  ordered_json out = std::move(input->head);
  Append(posturography::Measure(input->stretches), out);
  return out;
}

}  // namespace

void AddBoardCommand(CLI::App& app, Shared& shared) {
  auto* command = app.add_subcommand("board", "Sway measures of a person standing on one board");
  const auto options = std::make_shared<Options>();
  auto* corners =
      command->add_option("--corners", options->corners,
                          "Corner loads of one board, CSV time_s,tl_kg,tr_kg,bl_kg,br_kg, or "
                          "footingd_boards.csv of footing-log export");
  auto* cop = command->add_option("--cop", options->cop,
                                  "COP in place of corner loads, CSV time_s,x_mm,y_mm: x to the "
                                  "right (ML), y to the front (AP)");
  corners->excludes(cop);
  command
      ->add_option("--board", options->board,
                   "Board of an export with several: its role (left_board) or device number")
      ->needs(corners);
  auto* rate =
      command
          ->add_option("--rate-hz", options->rate_hz,
                       "Uniform rate to resample to by window averages, Hz (default: as recorded)")
          ->check(CLI::Range(1.0, 1000.0));
  command
      ->add_option("--window-s", options->window_s,
                   "Window of the averages, s (default: 2 intervals of the slower rate)")
      ->needs(rate)
      ->check(CLI::Range(0.001, 10.0));
  command
      ->add_option("--spacing-x-mm", options->spacing_x_mm,
                   "Distance between the sensors along the long axis, mm")
      ->check(CLI::Range(1.0, 2000.0))
      ->capture_default_str();
  command
      ->add_option("--spacing-y-mm", options->spacing_y_mm,
                   "Distance between the sensors along the short axis, mm")
      ->check(CLI::Range(1.0, 2000.0))
      ->capture_default_str();
  command->callback([options, &shared] {
    if (options->corners.empty() && options->cop.empty()) {
      shared.exit_code = cli::Report(UsageError("board needs --corners CSV or --cop CSV"));
      return;
    }
    shared.exit_code = PrintResult(Evaluate(*options), shared.json);
  });
}

}  // namespace footing::eval
