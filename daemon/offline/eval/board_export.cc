#include "daemon/offline/eval/board_export.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <map>
#include <utility>

#include "daemon/offline/eval/table.h"

namespace footing::eval {
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
