#include "daemon/offline/eval/features_input.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <sstream>

#include "common/runtime/data_file.h"
#include "common/base/quantile.h"
#include "common/base/units.h"

namespace footing::eval {
namespace {

constexpr std::size_t kMostSampleBytes = 256u << 20;
/// No controller measures more than this (about 20 g); a larger number is in another unit.
constexpr double kMostMps2 = 200;
constexpr double kGrtZero = 0.5;
/// Values that differ by less are the same count, written with three decimals.
constexpr double kSameMps2 = 1e-3;

/// All fields of a line as numbers, or nothing.
std::optional<std::vector<double>> Numbers(std::string line) {
  std::replace(line.begin(), line.end(), ',', ' ');
  std::istringstream fields(line);
  std::vector<double> numbers;
  for (std::string field; fields >> field;) {
    char* end = nullptr;
    numbers.push_back(std::strtod(field.c_str(), &end));
    if (*end != '\0') return std::nullopt;
  }
  return numbers;
}

bool IsBlank(const std::string& line) {
  return line.find_first_not_of(" \t\r") == std::string::npos;
}

std::string At(const std::string& path, std::size_t line) {
  return path + ", line " + std::to_string(line);
}

/// The end of the range on one side (sign +1 or -1) of an axis; infinite when nothing shows it.
double EndOfRange(const std::vector<Eigen::Vector3d>& rows, int axis, double sign) {
  double most = 0;
  for (const auto& row : rows) most = std::max(most, sign * row(axis));
  int run = 0;
  for (const auto& row : rows) {
    run = sign * row(axis) >= most - kSameMps2 ? run + 1 : 0;
    if (run == 3 && most > 2.9 * kStandardGravityMps2) return most - kSameMps2;
  }
  return INFINITY;
}

double FitScale(const GrtRecording& recording) {
  // How much a row differs from the one before; the quieter half are those at rest or nearly so.
  std::vector<std::pair<double, double>> change_and_length;
  for (std::size_t i = 1; i < recording.rows.size(); ++i) {
    const Eigen::Vector3d& here = recording.rows[i].specific_force_mps2;
    const Eigen::Vector3d& before = recording.rows[i - 1].specific_force_mps2;
    change_and_length.emplace_back((here - before).norm(), here.norm());
  }
  std::sort(change_and_length.begin(), change_and_length.end());
  change_and_length.resize(std::max<std::size_t>(1, change_and_length.size() / 2));
  std::vector<double> lengths;
  for (const auto& entry : change_and_length) lengths.push_back(entry.second);
  return kStandardGravityMps2 / std::max(1e-6, text::Median(std::move(lengths)));
}

}  // namespace

Result<std::vector<Eigen::Vector3d>> ReadAccelerationCsv(const std::string& path) {
  const Result<std::string> text = config::ReadTextFile(path, kMostSampleBytes);
  if (!text) return text.error();
  std::istringstream lines(*text);
  std::vector<Eigen::Vector3d> rows;
  std::size_t number = 0;
  bool first = true;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (IsBlank(line)) continue;
    const auto numbers = Numbers(line);
    const bool header = first && !numbers;
    first = false;
    if (header) continue;
    if (!numbers || numbers->size() != 3) {
      return InvalidData(At(path, number) + ": expected three numbers ax,ay,az in m/s2, found '" +
                         line.substr(0, 60) + "'");
    }
    const Eigen::Vector3d row((*numbers)[0], (*numbers)[1], (*numbers)[2]);
    if (!row.allFinite() || row.cwiseAbs().maxCoeff() > kMostMps2) {
      return InvalidData(At(path, number) + ": accelerations must be within +-200 m/s2, found '" +
                         line.substr(0, 60) + "'; convert from g or counts first");
    }
    rows.push_back(row);
  }
  if (rows.empty()) return InvalidData(path + ": no rows ax,ay,az in it");
  return rows;
}

std::vector<std::uint32_t> ClippedAxes(const std::vector<Eigen::Vector3d>& rows,
                                       double range_mps2) {
  std::vector<std::uint32_t> clipped(rows.size(), 0);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      const double end = range_mps2 > 0 ? range_mps2 : EndOfRange(rows, axis, sign);
      for (std::size_t i = 0; i < rows.size(); ++i) {
        if (sign * rows[i](axis) >= end) clipped[i] |= 1u << axis;
      }
    }
  }
  return clipped;
}

Result<GrtRecording> ReadGrt(const std::string& path) {
  const Result<std::string> text = config::ReadTextFile(path, kMostSampleBytes);
  if (!text) return text.error();
  std::istringstream lines(*text);
  GrtRecording recording;
  std::size_t number = 0;
  bool in_rows = false;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (!in_rows || IsBlank(line)) {
      in_rows = in_rows || line.rfind("LabelledTrainingData:", 0) == 0;
      continue;
    }
    const auto numbers = Numbers(line);
    if (!numbers || numbers->size() != 4) {
      return InvalidData(At(path, number) + ": expected a class and three numbers, found '" +
                         line.substr(0, 60) + "'");
    }
    const Eigen::Vector3d value((*numbers)[1], (*numbers)[2], (*numbers)[3]);
    if (!value.allFinite() || value.minCoeff() < 0 || value.maxCoeff() > 1) {
      return InvalidData(At(path, number) + ": values must be between 0 and 1, found '" +
                         line.substr(0, 60) + "'");
    }
    recording.rows.push_back(
        {static_cast<int>((*numbers)[0]), value - Eigen::Vector3d::Constant(kGrtZero)});
  }
  if (recording.rows.size() < 2) {
    return InvalidData(path + ": no rows after a line 'LabelledTrainingData:'; is it a GRT file?");
  }
  recording.mps2_per_unit = FitScale(recording);
  for (auto& row : recording.rows) row.specific_force_mps2 *= recording.mps2_per_unit;
  return recording;
}

}  // namespace footing::eval
