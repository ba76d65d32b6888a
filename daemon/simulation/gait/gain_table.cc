#include "daemon/simulation/gait/gain_table.h"

#include <algorithm>
#include <cmath>

#include "common/base/result.h"
#include "common/base/text.h"
#include "common/stream/gait.h"

namespace footing::gait {
namespace {

using stream::Gait;
using text::Quoted;
using text::Shortest;

constexpr std::string_view kFirstColumns[] = {"gait", "set", "speed_mps"};
constexpr std::string_view kFirstUnits[] = {"-", "-", "m/s"};
constexpr std::size_t kFirst = 3;
constexpr double kFastestMps = 20;

using Cells = std::vector<std::string_view>;

/// One file while it is read.
class Reader {
 public:
  Reader(std::string_view text, const std::string& origin) : lines_(text, origin) {}

  Result<void> Read(GainSets& sets) {
    int rows = 0;
    for (auto line = lines_.NextRow(); line; line = lines_.NextRow(), ++rows) {
      const Cells cells = text::Cells(*line);
      if (rows > 0 && cells.size() != kFirst + columns_.size()) {
        return Wrong(std::to_string(cells.size()) + " cells where " +
                     std::to_string(kFirst + columns_.size()) + " columns are named");
      }
      const Result<void> read = rows == 0   ? ReadNames(cells)
                                : rows == 1 ? CheckUnits(cells)
                                            : ReadSet(cells, sets);
      if (!read) return read;
    }
    if (rows < 3) {
      return InvalidData(lines_.file() +
                         ": needs a row of names, one of units and one a set; has " +
                         std::to_string(rows) + " rows");
    }
    return {};
  }

 private:
  Error Wrong(const std::string& what) const { return lines_.Fault(what); }

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
    const std::optional<double> value = text::ToNumber(cell);
    if (!value) {
      return Wrong(std::string(name) + " is " + Quoted(cell) + ", which is not a number");
    }
    if (*value < min || *value > max) {
      return Wrong(std::string(name) + " is " + std::string(cell) + ", allowed is " +
                   Shortest(min) + " to " + Shortest(max));
    }
    return *value;
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
                   Shortest(of_gait.back().speed_mps) + "; a gait's speeds must rise");
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

  text::Lines lines_;
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
  return Between(slower.gains, faster->gains, share);
}

}  // namespace

Gains Between(const Gains& a, const Gains& b, double share) {
  Gains gains = a;
  for (const GainField& field : GainFields()) {
    field.of(gains) = std::lerp(field.Of(a), field.Of(b), share);
  }
  return gains;
}

Result<void> GainTable::Add(std::string_view text, const std::string& origin) {
  GainSets read;
  if (const Result<void> done = Reader(text, origin).Read(read); !done) return done;
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
    rows += std::string(stream::Name(gait)) + "," + set.name + "," + Shortest(set.speed_mps);
    for (const GainField* column : columns) (rows += ',') += Shortest(column->Of(set.gains));
    rows += '\n';
  }
  std::string table;
  text::Lines lines(comment, "");
  while (const auto line = lines.Next()) table += "# " + std::string(*line) + "\n";
  return table + names + "\n" + units + "\n" + rows;
}

namespace {

template <typename Arrows, typename Phase, typename Cues>
Phase Follow(const Arrows& arrows, Phase phase, const Cues& cues) {
  for (const auto& arrow : arrows) {
    if (arrow.from == phase && cues.*arrow.cue) return arrow.to;
  }
  return phase;
}

/// A phase's name as one word of a diagram.
template <typename Phase>
std::string Word(Phase phase) {
  std::string word = Name(phase);
  std::replace(word.begin(), word.end(), ' ', '_');
  return word;
}

template <typename Arrows>
std::string Draw(const Arrows& arrows) {
  std::string text = "stateDiagram-v2\n";
  for (const auto& arrow : arrows) {
    text += "  " + Word(arrow.from) + " --> " + Word(arrow.to) + ": " + arrow.when + "\n";
  }
  return text;
}

}  // namespace

const char* Name(WalkingPhase phase) {
  switch (phase) {
    case WalkingPhase::kDoubleSupport:
      return "double support";
    case WalkingPhase::kRise:
      return "rise";
    case WalkingPhase::kFall:
      return "fall";
  }
  FOOTING_CHECK(false);
}

const char* Name(RunningPhase phase) {
  switch (phase) {
    case RunningPhase::kUpwardFlight:
      return "upward flight";
    case RunningPhase::kDownwardFlight:
      return "downward flight";
    case RunningPhase::kCompression:
      return "compression";
    case RunningPhase::kExtension:
      return "extension";
  }
  FOOTING_CHECK(false);
}

WalkingPhase Next(WalkingPhase phase, const WalkingCues& cues) {
  return Follow(kWalkingArrows, phase, cues);
}

RunningPhase Next(RunningPhase phase, const RunningCues& cues) {
  return Follow(kRunningArrows, phase, cues);
}

std::string DrawWalkingMachine() { return Draw(kWalkingArrows); }
std::string DrawRunningMachine() { return Draw(kRunningArrows); }

}  // namespace footing::gait
