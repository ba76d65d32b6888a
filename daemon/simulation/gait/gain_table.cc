#include "daemon/simulation/gait/gain_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "daemon/simulation/gait/phase.h"

namespace footing::gait {
namespace {

using stream::Gait;

constexpr std::string_view kFirstColumns[] = {"gait", "set", "speed_mps"};
constexpr std::string_view kFirstUnits[] = {"-", "-", "m/s"};
constexpr std::size_t kFirst = 3;
constexpr double kFastestMps = 20;

using Cells = std::vector<std::string_view>;

Cells Split(std::string_view line) {
  Cells cells;
  while (true) {
    const std::size_t comma = line.find(',');
    std::string_view cell = line.substr(0, comma);
    while (!cell.empty() && cell.front() == ' ') cell.remove_prefix(1);
    while (!cell.empty() && (cell.back() == ' ' || cell.back() == '\r')) cell.remove_suffix(1);
    cells.push_back(cell);
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

std::string Quoted(std::string_view text) { return "\"" + std::string(text) + "\""; }

std::string Text(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

/// One file while it is read. Every error begins with the file and the line.
class Reader {
 public:
  explicit Reader(std::string origin) : origin_(std::move(origin)) {}

  Result<void> Read(std::string_view text, GainSets& sets) {
    int rows = 0;
    while (!text.empty()) {
      const std::size_t end = text.find('\n');
      const std::string_view line = text.substr(0, end);
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      ++line_;
      if (line.empty() || line.front() == '#' || line == "\r") continue;
      const Cells cells = Split(line);
      if (rows > 0 && cells.size() != kFirst + columns_.size()) {
        return Wrong(std::to_string(cells.size()) + " cells where " +
                     std::to_string(kFirst + columns_.size()) + " columns are named");
      }
      const Result<void> read = rows == 0   ? ReadNames(cells)
                                : rows == 1 ? CheckUnits(cells)
                                            : ReadSet(cells, sets);
      if (!read) return read;
      ++rows;
    }
    if (rows < 3) {
      return InvalidData(origin_ + ": needs a row of names, one of units and one a set; has " +
                         std::to_string(rows) + " rows");
    }
    return {};
  }

 private:
  Error Wrong(const std::string& what) const {
    return InvalidData(origin_ + ":" + std::to_string(line_) + ": " + what);
  }

  Result<void> ReadNames(const Cells& cells) {
    for (std::size_t i = 0; i < cells.size() || i < kFirst; ++i) {
      if (i < kFirst) {
        if (i < cells.size() && cells[i] == kFirstColumns[i]) continue;
        return Wrong("the columns must begin with gait,set,speed_mps");
      }
      const GainField* field = FindGain(cells[i]);
      if (field == nullptr) {
        return Wrong("unknown gain " + Quoted(cells[i]) + "; gains.h has them all");
      }
      if (std::find(columns_.begin(), columns_.end(), field) != columns_.end()) {
        return Wrong(std::string(field->name) + " has two columns");
      }
      columns_.push_back(field);
    }
    return {};
  }

  Result<void> CheckUnits(const Cells& cells) const {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::string_view unit = i < kFirst ? kFirstUnits[i] : columns_[i - kFirst]->unit;
      const std::string_view name = i < kFirst ? kFirstColumns[i] : columns_[i - kFirst]->name;
      if (cells[i] == unit) continue;
      return Wrong("the unit of " + std::string(name) + " is " + Quoted(cells[i]) + ", must be " +
                   Quoted(unit));
    }
    return {};
  }

  Result<double> Number(std::string_view cell, std::string_view name, double min,
                        double max) const {
    double value = 0;
    const char* end = cell.data() + cell.size();
    const auto read = std::from_chars(cell.data(), end, value);
    if (read.ec != std::errc() || read.ptr != end || !std::isfinite(value)) {
      return Wrong(std::string(name) + " is " + Quoted(cell) + ", which is not a number");
    }
    if (value < min || value > max) {
      return Wrong(std::string(name) + " is " + std::string(cell) + ", allowed is " + Text(min) +
                   " to " + Text(max));
    }
    return value;
  }

  Result<void> ReadSet(const Cells& cells, GainSets& sets) const {
    const Gait gait = stream::GaitNamed(std::string(cells[0]));
    if (gait == Gait::kUnspecified) {
      return Wrong("gait is " + Quoted(cells[0]) + ", must be one of " + stream::GaitNames());
    }
    GainSet set;
    set.name = cells[1];
    if (set.name.empty()) return Wrong("the set has no name");
    const Result<double> speed = Number(cells[2], "speed_mps", 0, kFastestMps);
    if (!speed) return speed.error();
    set.speed_mps = *speed;
    std::vector<GainSet>& of_gait = sets[stream::IndexOf(gait)];
    if (!of_gait.empty() && set.speed_mps <= of_gait.back().speed_mps) {
      return Wrong("speed_mps is " + std::string(cells[2]) + " after " +
                   Text(of_gait.back().speed_mps) + "; a gait's speeds must rise");
    }
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const GainField& field = *columns_[i];
      const Result<double> value = Number(cells[kFirst + i], field.name, field.min, field.max);
      if (!value) return value.error();
      field.of(set.gains) = *value;
    }
    of_gait.push_back(std::move(set));
    return {};
  }

  std::string origin_;
  int line_ = 0;
  std::vector<const GainField*> columns_;
};

Gains Interpolated(const std::vector<GainSet>& sets, double speed_mps) {
  if (sets.empty()) return {};
  const auto faster = std::find_if(sets.begin(), sets.end(), [speed_mps](const GainSet& set) {
    return set.speed_mps >= speed_mps;
  });
  if (faster == sets.begin()) return sets.front().gains;
  if (faster == sets.end()) return sets.back().gains;
  const GainSet& slower = *std::prev(faster);
  const double share = (speed_mps - slower.speed_mps) / (faster->speed_mps - slower.speed_mps);
  Gains gains = slower.gains;
  for (const GainField& field : GainFields()) {
    field.of(gains) = std::lerp(field.Of(slower.gains), field.Of(faster->gains), share);
  }
  return gains;
}

}  // namespace

Result<void> GainTable::Add(std::string_view text, const std::string& origin) {
  GainSets read;
  if (const Result<void> done = Reader(origin).Read(text, read); !done) return done;
  for (std::size_t i = 0; i < sets_.size(); ++i) {
    if (!read[i].empty()) sets_[i] = std::move(read[i]);
  }
  return {};
}

void GainTable::Set(Gait gait, std::vector<GainSet> sets) {
  sets_[stream::IndexOf(gait)] = std::move(sets);
}

const std::vector<GainSet>& GainTable::SetsOf(Gait gait) const {
  return sets_[stream::IndexOf(gait)];
}

Gains GainTable::At(Gait gait, double desired_speed_mps) const {
  Gains gains = Interpolated(SetsOf(gait), desired_speed_mps);
  if (IsHopping(gait)) {
    gains.walking = Interpolated(SetsOf(Gait::kWalk), desired_speed_mps).walking;
  } else {
    gains.hopping = Interpolated(SetsOf(Gait::kRun), desired_speed_mps).hopping;
  }
  return gains;
}

std::string WriteGains(Gait gait, const std::vector<GainSet>& sets,
                       const std::vector<const GainField*>& columns, const std::string& comment) {
  std::string names = "gait,set,speed_mps", units = "-,-,m/s", rows;
  for (const GainField* column : columns) {
    (names += ',') += column->name;
    (units += ',') += column->unit;
  }
  for (const GainSet& set : sets) {
    rows += std::string(stream::Name(gait)) + "," + set.name + "," + Text(set.speed_mps);
    for (const GainField* column : columns) (rows += ',') += Text(column->Of(set.gains));
    rows += '\n';
  }
  std::string text;
  for (std::string_view rest = comment; !rest.empty();) {
    const std::size_t end = rest.find('\n');
    text += "# " + std::string(rest.substr(0, end)) + "\n";
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  return text + names + "\n" + units + "\n" + rows;
}

}  // namespace footing::gait
