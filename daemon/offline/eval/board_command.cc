#include "daemon/offline/eval/board_command.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "common/board/geometry.h"
#include "common/cli/cli.h"
#include "common/base/number.h"
#include "common/base/units.h"
#include "daemon/offline/eval/board_export.h"
#include "daemon/offline/eval/cop_filter.h"
#include "daemon/offline/eval/print_report.h"
#include "daemon/offline/eval/table.h"
#include "daemon/offline/analysis/board.h"
#include "daemon/offline/analysis/sway.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;
using posturography::Stretches;
using posturography::Sway;

/// More than anybody weighs, and less than a light adult's weight in newtons.
constexpr double kMostPersonKg = 300;

/// Below this, measures of sway are not comparable with those of others: 25 to 40 s are advised
/// (Scoppa F et al., Clinical stabilometry standardization, Gait & Posture 37(2), 2013).
constexpr double kShortestS = 20;
/// 20 s of samples end an interval sooner.
constexpr double kIntervalS = 0.1;

struct Options {
  std::string corners;
  std::string cop;
  std::string board;  ///< Of an export with several.
  CopFilterOptions filter;
  double least_s = kShortestS;
  posturography::BoardShape shape;
  double spacing_x_mm = board::kBalanceBoard.sensor_distance_x_m * 1e3;
  double spacing_y_mm = board::kBalanceBoard.sensor_distance_y_m * 1e3;
};

/// What there is to measure.
struct Input {
  ordered_json head;  ///< Fields of the answer that come before the measures.
  Stretches stretches;
  posturography::Gaps gaps;
  std::vector<std::string> warnings;  ///< What makes the measures less than they seem.
};

Result<BoardExport> ReadSamples(const Options& options) {
  if (IsBoardExport(options.corners)) return ReadBoardExport(options.corners, options.board);
  if (!options.board.empty()) {
    return UsageError("--board chooses a board of footing-log's export; " + options.corners +
                      " holds one board");
  }
  const auto rows = ReadTimeTable(options.corners, "time_s,tl_kg,tr_kg,bl_kg,br_kg");
  if (!rows) return rows.error();
  BoardExport read;
  read.samples.reserve(rows->size());
  for (const std::vector<double>& row : *rows) {
    read.samples.push_back({row[0],
                            {KilogramsToNewtons(row[1]), KilogramsToNewtons(row[2]),
                             KilogramsToNewtons(row[3]), KilogramsToNewtons(row[4])}});
  }
  return read;
}

/// What the file says about the board; null where it says nothing.
void AppendMarks(const BoardExport& board, Input& input) {
  const auto mark = [&](const char* name, const auto& value) {
    input.head[name] = value ? ordered_json(*value) : ordered_json(nullptr);
  };
  mark("simulated", board.simulated);
  mark("tared", board.tared);
  mark("calibrated", board.calibrated);
  mark("missing_ticks", board.missing_ticks);
  if (board.simulated.value_or(false)) input.warnings.push_back("the board is simulated");
  if (!board.tared.value_or(true)) {
    input.warnings.push_back("the board was not tared: its own weight is part of the loads");
  }
  if (!board.calibrated.value_or(true)) {
    input.warnings.push_back("the board's calibration was not read: its loads are approximate");
  }
  if (board.missing_ticks.value_or(0) > 0) {
    input.warnings.push_back(std::to_string(*board.missing_ticks) +
                             " ticks are missing in the recording");
  }
}

Result<Input> ReadCorners(const Options& options) {
  const auto read = ReadSamples(options);
  if (!read) return read.error();
  const std::vector<posturography::CornerSample>& samples = read->samples;
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
  input.gaps = standing.gaps;
  AppendMarks(*read, input);
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
  posturography::Standing standing = posturography::SplitAtGaps(samples);
  input.stretches = std::move(standing.stretches);
  input.gaps = standing.gaps;
  return input;
}

void AppendGaps(Input& input) {
  input.head["stretches"] = input.stretches.size();
  input.head["gaps"] = {{"count", input.gaps.count},
                        {"longest_s", input.gaps.longest_s},
                        {"seconds", input.gaps.seconds}};
  if (input.gaps.count == 0) return;
  input.warnings.push_back("samples are missing in " + std::to_string(input.gaps.count) +
                           (input.gaps.count == 1 ? " gap" : " gaps") +
                           "; nothing is measured across them");
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
  const std::string& file = corners ? options.corners : options.cop;
  const Result<CopFilter> filter = CopFilterOf(options.filter, corners);
  if (!filter) return filter.error();
  Result<Input> input = corners ? ReadCorners(options) : ReadCop(options);
  if (!input) return input.error();
  AppendGaps(*input);
  const auto filtered = FilterCop(*filter, input->stretches, input->head);
  if (!filtered) return filtered.error();
  if (filter->rate_hz <= 0) {
    input->warnings.push_back(
        "the COP is not filtered: noise and uneven sampling make the path longer");
  }
  std::size_t samples = 0;
  for (const auto& stretch : input->stretches) samples += stretch.size();
  const double duration_s = DurationS(input->stretches);
  if (samples < 3 || duration_s <= 0) {
    return InvalidData(file + ": measures of sway need 3 samples of a COP over some time; it has " +
                       std::to_string(samples));
  }
  if (duration_s < options.least_s - kIntervalS) {
    return InvalidData(file + ": the person stood for " + text::Fixed(duration_s, 2) +
                       " s; measures of sway need " + text::Shortest(options.least_s) +
                       " s to be comparable; record longer, or accept less with --min-seconds");
  }
  ordered_json out = std::move(input->head);
  Append(posturography::Measure(input->stretches), out);
  out["warnings"] = input->warnings;
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
  command->add_option("--rate-hz", options->filter.rate,
                      "Even rate to resample to by window averages, Hz, or recorded (default: 50 "
                      "with --corners, recorded with --cop)");
  command->add_option("--cutoff-hz", options->filter.cutoff,
                      "Low-pass without lag, Butterworth of 4th order: its cutoff, Hz, or none "
                      "(default: 10 with --corners, none with --cop or below 28 Hz)");
  command
      ->add_option("--window-s", options->filter.window_s,
                   "Window of the averages, s (default: 2 intervals of the slower rate)")
      ->check(CLI::Range(0.001, 10.0));
  command
      ->add_option("--min-seconds", options->least_s, "Least time of standing that is evaluated, s")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
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
