#include "common/virtual/motion/table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/virtual/motion/asf.h"
#include "common/virtual/motion/markers.h"
#include "common/virtual/motion/motion.h"

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
      const std::string_view word = text::PopWord(*line);
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

namespace {

/// One frame's numbers as they come in: which bones have been seen.
class Frame {
 public:
  Frame(const AsfSkeleton& asf, double radians)
      : asf_(asf), radians_(radians), seen_(asf.bones.size()), root_(3) {
    root_.setZero();
  }

  void Begin() {
    std::fill(seen_.begin(), seen_.end(), false);
    root_seen_ = false;
  }

  /// One line "BONE number ...". `q` is the frame's column.
  Result<void> Take(std::string_view line, const text::Lines& lines, Eigen::VectorXd& q) {
    const std::string_view name = text::PopWord(line);
    if (name == "root") {
      if (std::exchange(root_seen_, true)) return lines.Fault("a second root in one frame");
      return TakeRoot(line, lines, q);
    }
    std::size_t bone = next_;  // Mostly the next of the last frame.
    if (bone >= asf_.bones.size() || asf_.bones[bone].name != name) {
      for (bone = 0; bone < asf_.bones.size() && asf_.bones[bone].name != name; ++bone) {
      }
      if (bone == asf_.bones.size()) {
        return lines.Fault("bone " + text::Quoted(name) +
                           " is not in the skeleton, or does not turn");
      }
    }
    next_ = bone + 1;
    if (seen_[bone]) return lines.Fault("a second " + std::string(name) + " in one frame");
    seen_[bone] = true;
    for (const int dof : asf_.bones[bone].dofs) {
      const auto number = Next(line, lines, name);
      if (!number) return number.error();
      q(dof) = *number * radians_;
    }
    return End(line, lines, name);
  }

  /// Nothing, or the name of what the frame lacks.
  std::string Missing() const {
    if (!root_seen_) return "root";
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      if (!seen_[i]) return asf_.bones[i].name;
    }
    return {};
  }

 private:
  Result<double> Next(std::string_view& line, const text::Lines& lines,
                      std::string_view name) const {
    const std::string_view word = text::PopWord(line);
    const auto number = ToValue(word);
    if (number) return *number;
    return lines.Fault("expected a number of " + std::string(name) + " within +-1e9, found " +
                       (word.empty() ? "the end of the line" : text::Quoted(word)));
  }
  Result<void> End(std::string_view line, const text::Lines& lines, std::string_view name) const {
    if (text::Trim(line).empty()) return {};
    return lines.Fault("more numbers than " + std::string(name) + " has degrees of freedom");
  }

  Result<void> TakeRoot(std::string_view line, const text::Lines& lines, Eigen::VectorXd& q) {
    body::Joint file_root = asf_.file_root;
    file_root.first_dof = 0;
    for (const auto& which : asf_.root_numbers) {
      const auto number = Next(line, lines, "root");
      if (!number) return number.error();
      if (which.rotation) {
        root_(which.index) = *number * radians_;
      } else {
        q(which.index) = *number * asf_.unit_m + asf_.root_position_m(which.index);
      }
    }
    // R A, not the C A C^T of a bone: the root's orientation is where it starts.
    const Eigen::Matrix3d R = body::JointRotation(file_root, root_) * file_root.axes;
    body::SetJointRotation(asf_.skeleton.joint(0), R, q);
    return End(line, lines, "root");
  }

  const AsfSkeleton& asf_;
  double radians_;
  std::vector<bool> seen_;
  bool root_seen_ = false;
  std::size_t next_ = 0;
  Eigen::VectorXd root_;
};

}  // namespace

Result<Motion> ParseAmc(std::string_view text, const std::string& file, const AsfSkeleton& asf,
                        double rate_hz) {
  if (!IsRate(rate_hz)) return UsageError("a rate of " + std::to_string(rate_hz) + " Hz");
  text::Lines lines(text, file);
  double radians = asf.radians_per_angle;
  auto line = lines.NextFull();
  for (; line; line = lines.NextFull()) {
    const std::string_view word = text::Trim(*line);
    if (word[0] == '#') continue;
    if (word[0] != ':') break;
    if (word == ":DEGREES") radians = kPi / 180;
    if (word == ":RADIANS") radians = 1;
  }
  std::vector<double> values;
  const auto dof = static_cast<std::size_t>(asf.skeleton.dof);
  Frame frame(asf, radians);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(asf.skeleton.dof);
  std::size_t frames = 0;
  std::optional<std::uint64_t> last;  // Its number.
  while (line) {
    const std::string_view word = text::Trim(*line);
    const auto number = text::ToCount(word);
    if (!number) {
      return lines.Fault("expected the number of a frame, found " + text::Quoted(word));
    }
    if (last && *number != *last + 1) {
      return lines.Fault("frame " + std::to_string(*number) + " follows frame " +
                         std::to_string(*last) + "; frames are missing or in another order");
    }
    last = *number;
    if (values.size() + dof > kMostValues) {
      return lines.Fault("over " + std::to_string(kMostValues) + " values");
    }
    frame.Begin();
    for (line = lines.NextFull(); line && !text::ToCount(text::Trim(*line));
         line = lines.NextFull()) {
      const auto done = frame.Take(*line, lines, q);
      if (!done) return done.error();
    }
    if (const std::string missing = frame.Missing(); !missing.empty()) {
      return lines.Fault("frame " + std::to_string(*number) + " ends without " + missing);
    }
    values.insert(values.end(), q.data(), q.data() + q.size());
    ++frames;
  }
  if (frames == 0) return lines.Fault("no frame in the file");
  Motion motion{asf.skeleton, rate_hz, 0, {}};
  motion.q = Eigen::Map<const Eigen::MatrixXd>(values.data(), asf.skeleton.dof,
                                               static_cast<Eigen::Index>(frames));
  return motion;
}

namespace {

constexpr double kMissingTrcValue = std::numeric_limits<double>::quiet_NaN();
constexpr int kPlaceDecimals = 5;  // Decimals of millimetres.
constexpr int kTimeDecimals = 6;

/// Fields between tabs that are not empty.
std::vector<std::string_view> FullFields(std::string_view line) {
  std::vector<std::string_view> full;
  for (const std::string_view field : text::Fields(line, '\t')) {
    if (!field.empty()) full.push_back(field);
  }
  return full;
}

struct Head {
  double rate_hz = 0;
  double unit_m = 0;
  double frames = 0;  ///< As it says, which may be fewer than there are.
};

Result<Head> ParseHead(text::Lines& lines) {
  auto line = lines.Next();
  if (!line || text::Trim(*line).substr(0, 12) != "PathFileType") {
    return lines.Fault("not a TRC file: expected PathFileType");
  }
  line = lines.Next();
  const auto keys = FullFields(line.value_or(""));
  line = lines.Next();
  const auto values = FullFields(line.value_or(""));
  Head head;
  for (std::size_t i = 0; i < keys.size() && i < values.size(); ++i) {
    if (keys[i] == "DataRate") head.rate_hz = text::ToNumber(values[i]).value_or(0);
    if (keys[i] == "NumFrames") head.frames = text::ToNumber(values[i]).value_or(0);
    if (keys[i] == "Units") head.unit_m = MetresOf(values[i]);
  }
  if (!IsRate(head.rate_hz)) return lines.Fault("expected DataRate from 0.1 to 100000 Hz");
  if (head.unit_m == 0) return lines.Fault("expected Units m, cm or mm");
  return head;
}

/// One coordinate; nothing where the field has no number in it.
std::optional<double> Coordinate(const std::vector<std::string_view>& fields, std::size_t index) {
  return index < fields.size() ? ToValue(fields[index]) : std::nullopt;
}

bool IsGap(std::string_view field) {
  return field.empty() || text::EqualsIgnoringCase(field, "nan") ||
         text::EqualsIgnoringCase(field, "-nan");
}

/// Times are rounded, but no frame is missing, and none has another's place.
bool IsNext(double steps) { return steps > 0.5 && steps < 1.5; }

constexpr const char* kNotNext =
    " s is not a frame of DataRate after the one before; frames are missing or in another order, "
    "or DataRate is wrong";

}  // namespace

double MetresOf(std::string_view unit) {
  constexpr std::array<std::pair<double, std::string_view>, 3> kNames{
      {{1, "m meter metre"},
       {1e-2, "cm centimeter centimetre"},
       {1e-3, "mm millimeter millimetre"}}};
  std::string name = text::Lower(std::string(text::Trim(unit)));
  if (name.size() > 2 && name.back() == 's') name.pop_back();
  for (const auto& [metres, names] : kNames) {
    for (const std::string_view one : text::SplitAtBlanks(names)) {
      if (name == one) return metres;
    }
  }
  return 0;
}

Result<MarkerTracks> ParseTrc(std::string_view text, const std::string& file) {
  text::Lines lines(text, file);
  const auto head = ParseHead(lines);
  if (!head) return head.error();
  MarkerTracks tracks;
  tracks.rate_hz = head->rate_hz;
  const auto names = FullFields(lines.Next().value_or(""));
  if (names.size() < 3 || names[0] != "Frame#") {
    return lines.Fault("expected Frame#, Time and the names of markers");
  }
  const std::size_t markers = names.size() - 2;
  if (3 * markers > kMostColumns) return lines.Fault("too many markers");
  for (std::size_t i = 2; i < names.size(); ++i) tracks.names.emplace_back(names[i]);
  lines.Next();  // X1 Y1 Z1 ...
  std::vector<std::vector<Eigen::Vector3d>> places(markers);
  std::size_t frames = 0;
  double last_s = 0;
  for (auto line = lines.NextFull(); line; line = lines.NextFull()) {
    const auto fields = text::Fields(*line, '\t');
    if (fields[0].empty()) continue;
    if ((frames + 1) * 3 * markers > kMostValues) return lines.Fault("too many frames");
    const auto time_s = Coordinate(fields, 1);
    if (!text::ToNumber(fields[0]) || !time_s)
      return lines.Fault("expected a frame number and a time");
    if (frames == 0) tracks.start_s = *time_s;
    if (frames > 0 && !IsNext((*time_s - last_s) * head->rate_hz)) {
      return lines.Fault("the time " + std::string(fields[1]) + kNotNext);
    }
    last_s = *time_s;
    for (std::size_t marker = 0; marker < markers; ++marker) {
      Eigen::Vector3d p;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t at = 2 + 3 * marker + axis;
        const auto number = Coordinate(fields, at);
        if (!number && at < fields.size() && !IsGap(fields[at])) {
          return lines.Fault("marker " + tracks.names[marker] +
                             ": expected a number within +-1e9, found " + text::Quoted(fields[at]));
        }
        p(static_cast<int>(axis)) = number ? *number * head->unit_m : kMissingTrcValue;
      }
      const bool seen = p.allFinite() && !p.isZero(0);
      places[marker].push_back(seen ? p : Eigen::Vector3d::Constant(kMissingTrcValue));
    }
    ++frames;
  }
  if (frames == 0) return lines.Fault("no frame in the file");
  if (static_cast<double>(frames) < head->frames) {
    return lines.Fault("the file ends after frame " + std::to_string(frames) +
                       ", and NumFrames is " + std::to_string(std::llround(head->frames)));
  }
  for (auto& track : places) {
    tracks.p.emplace_back(3, static_cast<Eigen::Index>(frames));
    for (std::size_t i = 0; i < frames; ++i) {
      tracks.p.back().col(static_cast<Eigen::Index>(i)) = track[i];
    }
    track = {};
  }
  return tracks;
}

std::string WriteTrc(const MarkerTracks& tracks, const std::string& name) {
  const std::string frames = std::to_string(tracks.frames());
  std::string rate;
  text::AppendFixed(rate, tracks.rate_hz, kTimeDecimals);
  std::string text = "PathFileType\t4\t(X/Y/Z)\t" + name +
                     "\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\t"
                     "OrigDataStartFrame\tOrigNumFrames\n" +
                     rate + "\t" + rate + "\t" + frames + "\t" +
                     std::to_string(tracks.names.size()) + "\tmm\t" + rate + "\t1\t" + frames +
                     "\nFrame#\tTime";
  for (const std::string& marker : tracks.names) text += "\t" + marker + "\t\t";
  text += "\n\t";
  for (std::size_t i = 1; i <= tracks.names.size(); ++i) {
    for (const char axis : {'X', 'Y', 'Z'}) text += std::string("\t") + axis + std::to_string(i);
  }
  text += "\n\n";
  for (Eigen::Index frame = 0; frame < tracks.frames(); ++frame) {
    text += std::to_string(frame + 1) + "\t";
    text::AppendFixed(text, tracks.start_s + static_cast<double>(frame) / tracks.rate_hz,
                      kTimeDecimals);
    for (const Eigen::Matrix3Xd& track : tracks.p) {
      const Eigen::Vector3d p = track.col(frame);
      for (int axis = 0; axis < 3; ++axis) {
        text += '\t';
        if (Seen(p)) text::AppendFixed(text, 1000 * p(axis), kPlaceDecimals);
      }
    }
    // OpenSim drops an empty last field unless a tab ends it.
    if (text.back() == '\t') text += '\t';
    text += '\n';
  }
  return text;
}

}  // namespace footing::motion
