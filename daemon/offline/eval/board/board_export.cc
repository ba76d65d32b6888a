#include "daemon/offline/eval/board/board_export.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <map>

#include "daemon/offline/eval/report/table.h"

namespace footing::eval {
namespace {

/// The columns of the export that are read; the role came later than the others.
enum ExportColumn : std::size_t {
  kDevice,
  kSampledNs,
  kTopLeftN,
  kTopRightN,
  kBottomLeftN,
  kBottomRightN,
  kRole
};
const std::vector<std::string>& ExportColumns() {
  static const std::vector<std::string> names = {"device",      "sampled_ns",    "top_left_n",
                                                 "top_right_n", "bottom_left_n", "bottom_right_n",
                                                 "device_role"};
  return names;
}

using ExportRow = std::vector<std::string>;

template <typename Number>
bool ParseCell(const std::string& cell, Number& value) {
  const char* const end = cell.data() + cell.size();
  const auto parsed = std::from_chars(cell.data(), end, value);
  return parsed.ec == std::errc() && parsed.ptr == end;
}

std::string RoleOf(const ExportRow& cells) { return cells.size() > kRole ? cells[kRole] : ""; }

/// The device number that `board` means; see ReadBoardExport.
Result<std::string> ChooseBoard(const std::string& path, const std::vector<ExportRow>& rows,
                                const std::string& board) {
  std::map<std::string, std::string> boards;  // Roles by device number.
  for (const ExportRow& cells : rows) boards[cells[kDevice]] = RoleOf(cells);
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

Result<std::vector<posturography::CornerSample>> ReadBoardExport(const std::string& path,
                                                                 const std::string& board) {
  std::vector<std::string> names = ExportColumns();
  const std::vector<std::string> header = ReadHeader(path);
  if (std::find(header.begin(), header.end(), names[kRole]) == header.end()) names.pop_back();
  const auto rows = ReadNamedColumns(path, names);
  if (!rows) return rows.error();
  const auto device = ChooseBoard(path, *rows, board);
  if (!device) return device.error();
  std::vector<posturography::CornerSample> samples;
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
    if (samples.empty()) first_ns = sampled_ns;
    const double time_s = 1e-9 * static_cast<double>(sampled_ns - first_ns);
    if (!samples.empty() && time_s < samples.back().time_s) continue;  // Sent again by a resume.
    samples.push_back({time_s, forces_n[0], forces_n[1], forces_n[2], forces_n[3]});
  }
  return samples;
}

}  // namespace footing::eval
