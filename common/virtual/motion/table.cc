#include "common/virtual/motion/table.h"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "common/base/lines.h"
#include "common/base/number.h"
#include "common/virtual/motion/markers.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/motion/rate.h"
#include "common/virtual/motion/value.h"

namespace footing::motion {
namespace {

/// "key=value" or "key value" of a header line.
std::string_view ValueOf(std::string_view line, std::string_view key) {
  line = text::Trim(line);
  if (line.size() <= key.size() || !text::EqualsIgnoringCase(line.substr(0, key.size()), key))
    return {};
  const char after = line[key.size()];
  if (after != '=' && after != ' ' && after != '\t') return {};
  return text::Trim(line.substr(key.size() + 1));
}

struct Announced {
  std::optional<std::size_t> rows, columns;
};

Result<Announced> ParseHead(text::Lines& lines, Table& table) {
  Announced announced;
  bool first = true;
  for (auto line = lines.Next(); line; line = lines.Next()) {
    if (text::EqualsIgnoringCase(text::Trim(*line), "endheader")) return announced;
    const auto name = ValueOf(*line, "name");
    if (first && text::Trim(*line).find('=') == std::string_view::npos)
      table.name = text::Trim(*line);
    if (!name.empty()) table.name = name;
    first = false;
    for (const std::string_view key : {"nRows", "datarows"}) {
      if (const auto value = ValueOf(*line, key); !value.empty())
        announced.rows = text::ToCount(value);
    }
    for (const std::string_view key : {"nColumns", "datacolumns"}) {
      if (const auto value = ValueOf(*line, key); !value.empty())
        announced.columns = text::ToCount(value);
    }
    if (text::EqualsIgnoringCase(ValueOf(*line, "inDegrees"), "yes")) table.in_degrees = true;
  }
  return lines.Fault("not a MOT or STO file: expected 'endheader'");
}

}  // namespace

int FindColumn(const Table& table, std::string_view name) {
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (table.columns[i] == name) return static_cast<int>(i);
  }
  return -1;
}

Result<Table> ParseTable(std::string_view text, const std::string& file) {
  text::Lines lines(text, file);
  Table table;
  const auto announced = ParseHead(lines, table);
  if (!announced) return announced.error();
  const auto labels = text::SplitAtBlanks(lines.NextFull().value_or(""));
  if (labels.size() < 2) return lines.Fault("expected the names of at least two columns");
  if (labels.size() > kMostColumns) return lines.Fault("too many columns");
  if (announced->columns && *announced->columns != labels.size()) {
    return lines.Fault(std::to_string(*announced->columns) + " columns are announced, " +
                       std::to_string(labels.size()) + " named");
  }
  for (const std::string_view label : labels) table.columns.emplace_back(label);
  std::vector<double> values;
  for (auto line = lines.NextFull(); line; line = lines.NextFull()) {
    if (values.size() + labels.size() > kMostValues) return lines.Fault("too many rows");
    for (const std::string& column : table.columns) {
      const std::string_view word = text::TakeWord(*line);
      const auto number = ToValue(word);
      if (!number) {
        return lines.Fault("column " + column + ": expected a number within +-1e9, found " +
                           (word.empty() ? "the end of the line" : text::Quoted(word)));
      }
      values.push_back(*number);
    }
    if (!text::Trim(*line).empty()) return lines.Fault("more numbers than columns");
  }
  const std::size_t rows = values.size() / labels.size();
  if (rows == 0) return lines.Fault("no row in the file");
  if (announced->rows && *announced->rows != rows) {
    return lines.Fault(std::to_string(*announced->rows) + " rows are announced, the file has " +
                       std::to_string(rows));
  }
  table.values =
      Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
          values.data(), static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(labels.size()));
  return table;
}

std::string WriteTable(const Table& table) {
  std::string text = table.name + "\nversion=1\nnRows=" + std::to_string(table.values.rows()) +
                     "\nnColumns=" + std::to_string(table.values.cols()) +
                     "\ninDegrees=" + (table.in_degrees ? "yes" : "no") + "\nendheader\n";
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    text += (i == 0 ? "" : "\t") + table.columns[i];
  }
  text += '\n';
  for (Eigen::Index row = 0; row < table.values.rows(); ++row) {
    for (Eigen::Index column = 0; column < table.values.cols(); ++column) {
      if (column > 0) text += '\t';
      const double value = table.values(row, column) + 0.0;  // Minus zero is zero.
      text::AppendShortest(text, value);
    }
    text += '\n';
  }
  return text;
}

Result<GroundForces> ToGroundForces(const Table& table, const std::string& file) {
  GroundForces forces;
  const Eigen::VectorXd times = table.values.col(0);
  const Eigen::Index rows = times.size();
  if (rows < 2) return InvalidData(file + ": one row; ground forces need at least two");
  const double step_s = (times(rows - 1) - times(0)) / static_cast<double>(rows - 1);
  if (!(step_s > 0) || !IsRate(1 / step_s)) return InvalidData(file + ": its times do not rise");
  for (Eigen::Index row = 0; row < rows; ++row) {
    if (std::abs(times(row) - times(0) - static_cast<double>(row) * step_s) > step_s / 2) {
      return InvalidData(file + ", row " + std::to_string(row + 1) + ": times at unequal steps");
    }
  }
  forces.rate_hz = RateOfStep(step_s);
  forces.start_s = times(0);
  // Three columns that begin with `stem`, in W; empty where there are none.
  const auto vector = [&](const std::string& stem) {
    Eigen::Matrix3Xd out(3, 0);
    const int x = FindColumn(table, stem + "x"), y = FindColumn(table, stem + "y");
    const int z = FindColumn(table, stem + "z");
    if (x < 0 || y < 0 || z < 0) return out;
    out.resize(3, rows);
    for (Eigen::Index row = 0; row < rows; ++row) {
      out.col(row) = ToWorld(
          FileAxes::kYUp,
          Eigen::Vector3d(table.values(row, x), table.values(row, y), table.values(row, z)));
    }
    return out;
  };
  for (const std::string& column : table.columns) {
    if (column.size() < 3 || column.substr(column.size() - 2) != "vx") continue;
    PlateForces plate;
    plate.name = column.substr(0, column.size() - 2);
    plate.force_W = vector(plate.name + "v");
    plate.cop_W = vector(plate.name + "p");
    if (plate.force_W.cols() == 0 || plate.cop_W.cols() == 0) {
      return InvalidData(file + ": " + column + " is without its vy, vz, px, py or pz");
    }
    if (plate.cop_W.cwiseAbs().maxCoeff() > 20) plate.cop_W *= 1e-3;
    plate.moment_W = vector(plate.name + "m");
    std::string torque = plate.name;
    if (const auto at = torque.rfind("force"); at != std::string::npos) {
      torque.replace(at, 5, "torque");
    }
    if (plate.moment_W.cols() == 0) plate.moment_W = vector(torque);
    if (plate.moment_W.cols() == 0) plate.moment_W = Eigen::Matrix3Xd::Zero(3, rows);
    forces.plates.push_back(std::move(plate));
  }
  if (forces.plates.empty()) {
    return InvalidData(file + ": no ground forces: expected columns such as ground_force_1_vx");
  }
  return forces;
}

}  // namespace footing::motion
