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

#include <nlohmann/json.hpp>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/board/geometry.h"
#include "common/cli/cli.h"
#include "common/posturography/sway.h"
#include "common/virtual/motion/edit.h"
#include "daemon/offline/eval/report.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;
using posturography::Stretches;

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
  posturography::CopFilterOptions filter;
  double least_s = kShortestS;
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
  stream::BoardGeometry geometry = board::kBalanceBoard;
  geometry.sensor_distance_x_m = options.spacing_x_mm / 1000;
  geometry.sensor_distance_y_m = options.spacing_y_mm / 1000;
  const posturography::StandingLimits limits;
  posturography::Standing standing =
      posturography::FindStanding(posturography::LoadsOn(samples, {}, geometry), limits);
  if (standing.weight_n <= 0) {
    return InvalidData(options.corners + ": no sample with a load above " +
                       std::to_string(NewtonsToKilograms(limits.least_body_weight_n)).substr(0, 4) +
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

/// Resamples and filters every stretch, and adds to the answer what was done. The even rate of the
/// samples behind it; 0: it is uneven.
Result<double> FilterCop(const posturography::CopFilter& filter, Input& input) {
  const double median_s = posturography::MedianInterval(input.stretches);
  const bool even = filter.rate_hz > 0;
  input.head["recorded_rate_hz"] = median_s > 0 ? 1 / median_s : 0.0;
  if (const auto done = posturography::ResampleAll(filter, input.stretches); !done) {
    return done.error();
  }
  posturography::LowPassAll(filter, input.stretches);
  const auto or_null = [](bool given, double value) {
    return given ? ordered_json(value) : ordered_json(nullptr);
  };
  input.head["filter"] = filter.Text();
  if (even) input.head["filter_window_s"] = filter.WindowS(median_s);
  input.head["rate_hz"] = or_null(even, filter.rate_hz);
  input.head["cutoff_hz"] = or_null(filter.cutoff_hz > 0, filter.cutoff_hz);
  return even ? filter.rate_hz : posturography::EvenRate(input.stretches);
}

void Append(const posturography::Sway& sway, ordered_json& out) {
  out["samples"] = sway.samples;
  for (const posturography::NamedMeasure& measure : posturography::Named(sway)) {
    out[measure.key] = measure.value ? ordered_json(*measure.value) : ordered_json(nullptr);
  }
  out["ellipse95_definition"] = posturography::kEllipseDefinition;
  out["spectrum_definition"] = posturography::kSpectrumDefinition;
  out["sample_entropy_definition"] = posturography::kEntropyDefinition;
}

Result<ordered_json> Evaluate(const Options& options) {
  const bool corners = !options.corners.empty();
  const std::string& file = corners ? options.corners : options.cop;
  const auto filter = posturography::CopFilterOf(options.filter, corners);
  if (!filter) return filter.error();
  Result<Input> input = corners ? ReadCorners(options) : ReadCop(options);
  if (!input) return input.error();
  AppendGaps(*input);
  const auto rate_hz = FilterCop(*filter, *input);
  if (!rate_hz) return rate_hz.error();
  if (filter->rate_hz <= 0) {
    input->warnings.push_back(
        "the COP is not filtered: noise and uneven sampling make the path longer");
  }
  std::size_t samples = 0;
  for (const auto& stretch : input->stretches) samples += stretch.size();
  const double duration_s = posturography::DurationS(input->stretches);
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
  Append(posturography::Measure(input->stretches, *rate_hz), out);
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
