#include "daemon/offline/eval/board.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/board/geometry.h"
#include "common/cli/cli.h"
#include "common/virtual/motion/edit.h"
#include "daemon/offline/analysis/sway.h"
#include "daemon/offline/eval/report.h"

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
  std::string board;  ///< Board to take from an export with several.
  CopFilterOptions filter;
  double least_s = kShortestS;
  posturography::BoardShape shape;
  double spacing_x_mm = board::kBalanceBoard.sensor_distance_x_m * 1e3;
  double spacing_y_mm = board::kBalanceBoard.sensor_distance_y_m * 1e3;
};

/// Samples to measure.
struct Input {
  ordered_json head;  ///< Fields of the answer that come before the measures.
  Stretches stretches;
  posturography::Gaps gaps;
  std::vector<std::string> warnings;  ///< Reasons why the measures are worth less than they seem.
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

/// Appends what the file states about the board; null where it states nothing.
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

namespace {

/// Advice of posturography: at least 50 Hz, and a low-pass at 10 Hz (Ruhe A et al., The
/// test-retest reliability of centre of pressure measures in bipedal static task conditions, Gait &
/// Posture 32(4), 2010; Scoppa F et al., Clinical stabilometry standardization, Gait & Posture
/// 37(2), 2013).
constexpr double kUsualRateHz = 50;
constexpr double kUsualCutoffHz = 10;
/// Above this share of the rate the low-pass leaves the signal as it is (motion::LowPass).
constexpr double kHighestCutoffOfRate = 0.36;
constexpr double kLowestRateHz = 1;
constexpr double kLowestCutoffHz = 0.1;
constexpr double kHighestHz = 1000;
/// 55 hours at 100 Hz: a guard against times in another unit.
constexpr double kMostResampled = 2e7;

constexpr const char* kAsRecorded = "recorded";
constexpr const char* kNone = "none";

struct FrequencyOption {
  const char* name;
  const std::string& text;
  const char* off;  ///< The word for no such filter.
  double lowest_hz;
};

/// The option in Hz, 0 where it is off, or `usual_hz` where it is not given.
Result<double> FrequencyOf(const FrequencyOption& option, double usual_hz) {
  if (option.text.empty()) return usual_hz;
  if (option.text == option.off) return 0.0;
  const auto hz = text::ToNumber(option.text);
  if (hz && *hz >= option.lowest_hz && *hz <= kHighestHz) return *hz;
  return UsageError(std::string(option.name) + " " + option.text + ": give " +
                    text::Shortest(option.lowest_hz) + " to 1000 Hz, or " + option.off);
}

void LowPass(const CopFilter& filter, std::vector<posturography::CopSample>& stretch) {
  Eigen::MatrixXd signal(2, static_cast<Eigen::Index>(stretch.size()));
  for (std::size_t i = 0; i < stretch.size(); ++i) {
    signal.col(static_cast<Eigen::Index>(i)) << stretch[i].x_m, stretch[i].y_m;
  }
  signal = motion::LowPass(signal, filter.rate_hz, filter.cutoff_hz);
  for (std::size_t i = 0; i < stretch.size(); ++i) {
    stretch[i].x_m = signal(0, static_cast<Eigen::Index>(i));
    stretch[i].y_m = signal(1, static_cast<Eigen::Index>(i));
  }
}

}  // namespace

Result<CopFilter> CopFilterOf(const CopFilterOptions& words, bool corners) {
  const auto rate_hz = FrequencyOf({"--rate-hz", words.rate, kAsRecorded, kLowestRateHz},
                                   corners ? kUsualRateHz : 0);
  if (!rate_hz) return rate_hz.error();
  const double highest_hz = kHighestCutoffOfRate * *rate_hz;
  const double usual_hz = corners && kUsualCutoffHz <= highest_hz ? kUsualCutoffHz : 0;
  const auto cutoff_hz =
      FrequencyOf({"--cutoff-hz", words.cutoff, kNone, kLowestCutoffHz}, usual_hz);
  if (!cutoff_hz) return cutoff_hz.error();
  if (*cutoff_hz > 0 && *rate_hz <= 0) {
    return UsageError("--cutoff-hz needs an even rate: give --rate-hz HZ");
  }
  if (words.window_s > 0 && *rate_hz <= 0) {
    return UsageError("--window-s is the window of --rate-hz HZ: give one");
  }
  if (*cutoff_hz > highest_hz) {
    return UsageError("--cutoff-hz " + words.cutoff + " is above 0.36 of the rate of " +
                      std::to_string(std::lround(*rate_hz)) + " Hz: lower it, or raise --rate-hz");
  }
  return CopFilter{*rate_hz, *cutoff_hz, words.window_s};
}

double DurationS(const posturography::Stretches& stretches) {
  double duration_s = 0;
  for (const auto& stretch : stretches) {
    duration_s += stretch.back().time_s - stretch.front().time_s;
  }
  return duration_s;
}

Result<void> FilterCop(const CopFilter& filter, posturography::Stretches& stretches,
                       ordered_json& answer) {
  const double median_s = posturography::MedianInterval(stretches);
  answer["recorded_rate_hz"] = median_s > 0 ? 1 / median_s : 0.0;
  if (filter.rate_hz <= 0) {
    answer["filter"] = kNone;
    answer["rate_hz"] = nullptr;
    answer["cutoff_hz"] = nullptr;
    return {};
  }
  const double duration_s = DurationS(stretches);
  if (duration_s * filter.rate_hz > kMostResampled) {
    return InvalidData("the recording lasts " + std::to_string(duration_s) +
                       " s, too long for --rate-hz; is its time in seconds?");
  }
  const double window_s =
      filter.window_s > 0 ? filter.window_s : std::max(2 / filter.rate_hz, 2 * median_s);
  for (std::vector<posturography::CopSample>& stretch : stretches) {
    stretch = posturography::Resample(stretch, filter.rate_hz, window_s);
    if (filter.cutoff_hz > 0) LowPass(filter, stretch);
  }
  std::string name = "SWARII window average (Audiffren & Contal 2016)";
  if (filter.cutoff_hz > 0) name += ", then Butterworth low-pass of 4th order without lag";
  answer["filter"] = name;
  answer["filter_window_s"] = window_s;
  answer["rate_hz"] = filter.rate_hz;
  answer["cutoff_hz"] =
      filter.cutoff_hz > 0 ? ordered_json(filter.cutoff_hz) : ordered_json(nullptr);
  return {};
}

namespace {

/// The columns of the export that are read. The later ones came with later versions.
enum ExportColumn : std::size_t {
  kDevice,
  kSampledNs,
  kTopLeftN,
  kTopRightN,
  kBottomLeftN,
  kBottomRightN,
  kRole,
  kSimulated,
  kTared,
  kUncalibrated
};
constexpr std::size_t kNecessaryColumns = kRole;
const std::vector<std::string>& ExportColumns() {
  static const std::vector<std::string> names = {
      "device",         "sampled_ns",  "top_left_n", "top_right_n", "bottom_left_n",
      "bottom_right_n", "device_role", "simulated",  "tared",       "uncalibrated"};
  return names;
}

using ExportRow = std::vector<std::string>;

template <typename Number>
bool ParseCell(const std::string& cell, Number& value) {
  const char* const end = cell.data() + cell.size();
  const auto parsed = std::from_chars(cell.data(), end, value);
  return parsed.ec == std::errc() && parsed.ptr == end;
}

/// The rows with a cell for each of ExportColumns(): empty where the file has no such column.
Result<std::vector<ExportRow>> ReadRows(const std::string& path) {
  const std::vector<std::string> header = ReadHeader(path);
  std::vector<std::string> names;
  std::vector<std::size_t> columns;
  for (std::size_t column = 0; column < ExportColumns().size(); ++column) {
    const std::string& name = ExportColumns()[column];
    const bool there = std::find(header.begin(), header.end(), name) != header.end();
    if (!there && column >= kNecessaryColumns) continue;
    names.push_back(name);
    columns.push_back(column);
  }
  auto read = ReadNamedColumns(path, names);
  if (!read) return read.error();
  std::vector<ExportRow> rows;
  rows.reserve(read->size());
  for (ExportRow& cells : *read) {
    ExportRow& row = rows.emplace_back(ExportColumns().size());
    for (std::size_t i = 0; i < columns.size(); ++i) row[columns[i]] = std::move(cells[i]);
  }
  return rows;
}

/// A flag that any sample sets; nothing where a sample does not have it.
void Or(const std::string& cell, bool first, std::optional<bool>& any) {
  if (cell.empty()) {
    any.reset();
  } else if (first) {
    any = cell == "1";
  } else if (any) {
    any = *any || cell == "1";
  }
}

/// Ticks that the recorder missed, by the file of gaps beside the boards'.
Result<std::optional<std::uint64_t>> MissingTicks(const std::string& path) {
  const std::string ending = "boards.csv";
  if (!path.ends_with(ending)) return std::optional<std::uint64_t>();
  const std::string stem = path.substr(0, path.size() - ending.size());
  if (!std::filesystem::exists(stem + "gaps.csv")) {
    std::optional<std::uint64_t> none;
    if (std::filesystem::exists(stem + "status.csv")) none = 0;
    return none;
  }
  const auto rows = ReadNamedColumns(stem + "gaps.csv", {"from_sequence", "to_sequence", "reason"});
  if (!rows) return rows.error();
  std::uint64_t missing = 0;
  for (const ExportRow& cells : *rows) {
    std::uint64_t from = 0, to = 0;
    if (!ParseCell(cells[0], from) || !ParseCell(cells[1], to) || to < from) {
      return InvalidData(stem + "gaps.csv has a range that is not a pair of numbers");
    }
    // Numbers begin again with a restarted server: nobody knows how many it did not send.
    if (cells[2] != "REASON_NEW_EPOCH") missing += to - from + 1;
  }
  return std::optional<std::uint64_t>(missing);
}

/// The device number that `board` means; see ReadBoardExport.
Result<std::string> ChooseBoard(const std::string& path, const std::vector<ExportRow>& rows,
                                const std::string& board) {
  std::map<std::string, std::string> boards;  // Roles by device number.
  for (const ExportRow& cells : rows) boards[cells[kDevice]] = cells[kRole];
  if (board.empty() && boards.size() == 1) return boards.begin()->first;
  std::string found;
  std::string known;
  for (const auto& [device, role] : boards) {
    if (device == board || (!role.empty() && role == board)) found = device;
    known += (known.empty() ? "" : ", ") + (role.empty() ? device : role + " (" + device + ")");
  }
  if (!found.empty()) return found;
  if (boards.empty()) return InvalidData(path + " holds no sample of a board");
  return UsageError(path + (board.empty() ? " holds several boards" : " has no board " + board) +
                    "; name one with --board: " + known);
}

}  // namespace

bool IsBoardExport(const std::string& path) {
  const std::vector<std::string> header = ReadHeader(path);
  return std::find(header.begin(), header.end(), ExportColumns()[kTopLeftN]) != header.end();
}

Result<BoardExport> ReadBoardExport(const std::string& path, const std::string& board) {
  const auto rows = ReadRows(path);
  if (!rows) return rows.error();
  const auto device = ChooseBoard(path, *rows, board);
  if (!device) return device.error();
  BoardExport read;
  std::optional<bool> untared, uncalibrated;
  std::vector<posturography::CornerSample>& samples = read.samples;
  std::int64_t first_ns = 0;
  for (const ExportRow& cells : *rows) {
    if (cells[kDevice] != *device) continue;
    std::int64_t sampled_ns = 0;
    std::array<double, 4> forces_n{};
    bool good = ParseCell(cells[kSampledNs], sampled_ns);
    for (std::size_t corner = 0; corner < forces_n.size(); ++corner) {
      good = good && ParseCell(cells[kTopLeftN + corner], forces_n[corner]);
    }
    if (!good) {
      return InvalidData(path + ": sample " + std::to_string(samples.size() + 1) + " of device " +
                         *device + " has a cell that is not a number");
    }
    const bool first = samples.empty();
    if (first) first_ns = sampled_ns;
    const double time_s = 1e-9 * static_cast<double>(sampled_ns - first_ns);
    if (!first && time_s < samples.back().time_s) continue;  // Sent again by a resume.
    samples.push_back({time_s, forces_n[0], forces_n[1], forces_n[2], forces_n[3]});
    Or(cells[kSimulated], first, read.simulated);
    Or(cells[kTared].empty() ? "" : cells[kTared] == "1" ? "0" : "1", first, untared);
    Or(cells[kUncalibrated], first, uncalibrated);
  }
  if (untared) read.tared = !*untared;
  if (uncalibrated) read.calibrated = !*uncalibrated;
  const auto missing = MissingTicks(path);
  if (!missing) return missing.error();
  read.missing_ticks = *missing;
  return read;
}

}  // namespace footing::eval
