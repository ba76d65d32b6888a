#include "clients/study/plan/ranges.h"

#include <algorithm>
#include <cmath>

#include "common/base/text.h"
#include "common/statistics/analysis.h"

namespace footing::study::ranges {
namespace {

using nlohmann::json;

using statistics::MedianOf;

Measured Read(const json& measured) {
  Measured one;
  one.played.interface = measured.at("interface").get<std::string>();
  one.played.turn_by = measured.value("turn_by", one.played.turn_by);
  one.provenance.participants = measured.at("participants").get<std::vector<std::string>>();
  one.provenance.when = measured.value("when", "");
  one.provenance.how = measured.value("how", "");
  one.provenance.by = measured.value("by", "");
  one.provenance.simulated = measured.value("simulated", false);
  for (const auto& [name, range] : measured.at("ranges").items()) {
    one.ranges[name] = {range.at("low").get<double>(), range.at("high").get<double>(),
                        range.value("seconds", 0.0)};
  }
  return one;
}

}  // namespace

Result<Measured> MeasuredOf(const std::string& table, const std::string& file) {
  const json root = json::parse(table, nullptr, false, true);
  if (!root.is_object() || !root.contains("measured")) {
    return InvalidData(file + " has no measured ranges; footing-study ranges measures them");
  }
  try {
    return Read(root["measured"]);
  } catch (const json::exception& error) {
    return InvalidData(file + ": measured: " + error.what());
  }
}

Result<Measured> Merge(const std::vector<Measured>& people) {
  if (people.size() < 2) return UsageError("a group needs the tables of two people or more");
  Measured group;
  group.played = people.front().played;
  for (const Measured& one : people) {
    if (one.played.interface != group.played.interface ||
        one.played.turn_by != group.played.turn_by) {
      return UsageError("the tables are of different interfaces: " + group.played.interface +
                        " and " + one.played.interface +
                        "; a group's are of one, with the same turn_by");
    }
    auto& participants = group.provenance.participants;
    for (const std::string& code : one.provenance.participants) {
      if (std::find(participants.begin(), participants.end(), code) != participants.end()) {
        return UsageError("participant " + code + " comes twice in the group");
      }
      participants.push_back(code);
    }
    group.provenance.simulated = group.provenance.simulated || one.provenance.simulated;
  }
  for (const auto& [name, range] : people.front().ranges) {
    std::vector<double> low, high;
    for (const Measured& one : people) {
      const auto found = one.ranges.find(name);
      if (found == one.ranges.end()) continue;
      low.push_back(found->second.low);
      high.push_back(found->second.high);
    }
    group.ranges[name] = {MedianOf(low), MedianOf(high), 0};
  }
  return group;
}

namespace {

std::vector<Motion> OfStick() {
  return {{"Push the stick as far forwards as is comfortable, and hold it there.", 5},
          {"Push it as far to the left.", 4},
          {"Push it as far to the right.", 4},
          {"Let it go.", 4}};
}

std::vector<Motion> OfBoards() {
  return {{"Step in place, as slowly as is comfortable.", 5},
          {"Faster: jog as fast as is comfortable, one foot on the boards.", 4},
          {"Stand. Rise quickly on your toes and come down, three times, gently.", 5},
          {"Three times, as hard as is comfortable, toes on the boards.", 5},
          {"Step in place and lean to the left, as far as is comfortable.", 4},
          {"Step and lean to the right.", 4},
          {"Stand on both feet and lean to the left, as far as is comfortable.", 3},
          {"Stand and lean to the right.", 3}};
}

}  // namespace

double DurationOf(const Played& played) {
  double duration_s = 0;
  for (const Motion& motion : MotionsOf(played)) duration_s += motion.duration_s;
  return duration_s;
}

std::vector<Motion> MotionsOf(const Played& played) {
  if (played.interface == "joystick") return OfStick();
  if (played.interface == "boards") return OfBoards();
  if (played.interface == "arm") {
    return {{"Swing straight arms in turns, as slowly as is comfortable.", 4},
            {"Faster: as fast as is comfortable.", 3},
            {"Bend your arms and swing them in turns, as slowly as is comfortable.", 3.5},
            {"Faster: as fast as is comfortable.", 2.5},
            {"Swing both arms together, gently.", 2.5},
            {"Together, as hard as is comfortable.", 2.5},
            {"Bend your arms and incline both to the left, as far as is comfortable.", 2},
            {"Incline both to the right.", 2}};
  }
  const bool leg = played.interface == "leg";
  const std::string who = played.turn_by == "trunk" ? "your trunk" : "your head";
  std::vector<Motion> motions{
      {leg ? "Step in place, as slowly as is comfortable."
           : "Swing in turns, as slowly as is comfortable.",
       5},
      {"Faster: as fast as is comfortable.", 3},
      {leg ? "Hop with both legs together, low." : "Swing both hands together, gently.", 3.5},
      {leg ? "Hop as high as is comfortable." : "Together, as hard as is comfortable.", 3.5}};
  if (leg && played.turn_by == "feet") {
    motions.push_back({"Step, and lift the right foot higher than the left.", 3});
    motions.push_back({"Step, and lift the left foot higher than the right.", 3});
  } else {
    const std::string what = leg ? who : "both wrists";
    motions.push_back({"Incline " + what + " to the left, as far as is comfortable.", 2.5});
    motions.push_back({"Incline " + what + " to the right.", 2.5});
  }
  return motions;
}

namespace {

using nlohmann::ordered_json;

/// The fastest comfortable motion must be this many times the slowest one, and the hardest this
/// many times the gentlest; otherwise the person did not vary it.
constexpr double kLeastFrequencyRatio = 1.3;
/// Less for accelerations, since hard landings clip at the end of the sensor's range.
constexpr double kLeastAmplitudeRatio = 1.2;
/// A turn begins at this share of the smaller of both sides' comfortable inclination, and ends at
/// that share of where it begins, as in the built-in tables.
constexpr double kTurnShare = 0.625, kStraightShare = 0.7;
/// A person who inclines no further does so unawares, degrees; or a share with turn_by feet.
constexpr double kLeastTurnDeg = 12, kMostTurnDeg = 80, kLeastTurnShare = 0.15;
/// A stick's radii: what is left of the way of a worn or stiff one, where running begins, and how
/// far beyond the rest its centre reaches.
constexpr double kLeastStick = 0.6, kFullStick = 0.95, kRunStick = 0.6, kCentreMargin = 0.1;

/// The same of boards, as shares of the load; and where an interface must begin to take a standing
/// person's lean for a turn, who leans by 0.2 without meaning it.
constexpr double kLeastStepLean = 0.15, kLeastStandLean = 0.3, kUnmeantLean = 0.22;
/// A heel rise counts from this share of the gentlest comfortable push on.
constexpr double kRiseCountsShare = 0.8;

std::string Text(double value) { return text::Fixed(value, value < 10 ? 2 : 1); }
double Rounded(double value) { return std::round(1e3 * value) / 1e3; }

Error Again(const std::string& what, const Range& range, const std::string& unit,
            const std::string& remedy) {
  return Failure(what + " is from " + Text(range.low) + " to " + Text(range.high) + unit + "; " +
                 remedy + ", and measure again");
}

class Table {
 public:
  Table(const Played& played, const Ranges& ranges, ordered_json& table)
      : played_(played), ranges_(ranges), table_(table) {}

  Result<void> Fill() {
    if (played_.interface == "joystick") return FillStick();
    if (played_.interface == "boards") return FillBoards();
    const auto swings = played_.interface == "arm" ? FillArms() : FillGaits(quantity::kAlternateHz);
    if (!swings) return swings;
    if (const auto jumps = FillJumps(); !jumps) return jumps;
    return FillTurn();
  }

 private:
  const Range& Of(const char* quantity) const { return ranges_.at(quantity); }
  double SmallerSide(const char* quantity) const {
    return std::min(-Of(quantity).low, Of(quantity).high);
  }
  void Set(const char* key, double value) { table_[key] = Rounded(value); }

  Result<void> CheckVaried(const char* quantity, const std::string& what) const {
    const Range& range = Of(quantity);
    if (range.low > 0 && range.high >= kLeastFrequencyRatio * range.low) return {};
    return Again(what, range, " Hz", "move clearly slower first and clearly faster then");
  }

  /// Walking below the border, running above it. It divides the person's range as that of the table
  /// divides the table's.
  Result<void> FillGaits(const char* quantity) {
    const auto varied = CheckVaried(quantity, "the frequency of the motion in turns");
    if (!varied) return varied;
    const Range& hz = Of(quantity);
    const auto built_in = [this](const char* key) { return table_[key].get<double>(); };
    const double slowest_hz = built_in("walk_frequency_min_hz");
    const double share = (built_in("walk_run_border_hz") - slowest_hz) /
                         (built_in("run_frequency_max_hz") - slowest_hz);
    const double border_hz = std::lerp(hz.low, hz.high, share);
    Set("walk_frequency_min_hz", hz.low);
    Set("walk_frequency_max_hz", border_hz);
    Set("run_frequency_min_hz", border_hz);
    Set("run_frequency_max_hz", hz.high);
    Set("walk_run_border_hz", border_hz);
    return {};
  }

  Result<void> FillBoards() {
    if (const auto gaits = FillGaits(quantity::kFootHz); !gaits) return gaits;
    const Range& push = Of(quantity::kRiseShare);
    if (push.high < kLeastAmplitudeRatio * push.low) {
      return Again("the push of the heel rises, as a share of the weight,", push, "",
                   "rise gently first and clearly harder then");
    }
    Set("jump_overshoot_min", push.low);
    Set("jump_overshoot_max", push.high);
    Set("heel_rise_overshoot",
        std::min(table_["heel_rise_overshoot"].get<double>(), kRiseCountsShare * push.low));
    const double steps = SmallerSide(quantity::kStepLean);
    if (steps < kLeastStepLean) {
      return Again("the lean of the steps, as a share of the load,", Of(quantity::kStepLean), "",
                   "lean further while you step, to both sides");
    }
    Set("turn_above", kTurnShare * steps);
    Set("straight_below", kStraightShare * kTurnShare * steps);
    const double stands = SmallerSide(quantity::kStandLean);
    if (stands < kLeastStandLean) {
      return Again("the lean of standing, as a share of the load,", Of(quantity::kStandLean), "",
                   "lean further on both feet, to both sides");
    }
    Set("standing_turn_above", std::max(kUnmeantLean, kTurnShare * stands));
    return {};
  }

  Result<void> FillArms() {
    for (const auto& [quantity, gait, what] :
         {std::tuple{quantity::kStraightHz, "walk", "the frequency of straight arms"},
          std::tuple{quantity::kBentHz, "run", "the frequency of bent arms"}}) {
      if (const auto varied = CheckVaried(quantity, what); !varied) return varied;
      const std::string key = std::string(gait) + "_frequency_";
      Set((key + "min_hz").c_str(), Of(quantity).low);
      Set((key + "max_hz").c_str(), Of(quantity).high);
    }
    return {};
  }

  Result<void> FillJumps() {
    const Range& amplitude = Of(quantity::kTogetherMps2);
    if (amplitude.high < kLeastAmplitudeRatio * amplitude.low) {
      return Again("the acceleration of the motion together", amplitude, " m/s2",
                   "jump low first and clearly higher then");
    }
    Set("jump_amplitude_min_mps2", amplitude.low);
    Set("jump_amplitude_max_mps2", amplitude.high);
    // Who jumps at one rhythm has said nothing of how slowly or fast that could be.
    const Range& hz = Of(quantity::kTogetherHz);
    if (hz.high < kLeastFrequencyRatio * hz.low) return {};
    Set("jump_frequency_min_hz", hz.low);
    Set("jump_frequency_max_hz", hz.high);
    return {};
  }

  Result<void> FillTurn() {
    const bool feet = played_.interface == "leg" && played_.turn_by == "feet";
    const Range& right = Of(quantity::kTurnRight);
    const double smaller = SmallerSide(quantity::kTurnRight);
    const std::string unit = feet ? "" : " degrees to the right";
    if (smaller < (feet ? kLeastTurnShare : kLeastTurnDeg)) {
      return Again("the inclination", right, unit, "incline further, to both sides");
    }
    if (!feet && smaller > kMostTurnDeg) {
      return Again("the inclination", right, unit, "hold the controllers as the interface asks");
    }
    Set(feet ? "feet_turn_above" : "turn_above_deg", kTurnShare * smaller);
    Set(feet ? "feet_straight_below" : "straight_below_deg", kStraightShare * kTurnShare * smaller);
    return {};
  }

  Result<void> FillStick() {
    const double full = std::min(Of(quantity::kForwardRadius).high, Of(quantity::kSideRadius).high);
    if (full < kLeastStick) {
      return Again("the radius of the stick", Of(quantity::kForwardRadius), "",
                   "push it further, forwards and to both sides");
    }
    const double centre = std::max(table_["centre_radius"].get<double>(),
                                   Of(quantity::kRestRadius).high + kCentreMargin);
    Set("centre_radius", centre);
    Set("run_radius", kRunStick * full);
    Set("walk_radius_min", centre);
    Set("walk_radius_max", kRunStick * full);
    Set("run_radius_min", kRunStick * full);
    Set("run_radius_max", kFullStick * full);
    return {};
  }

  const Played& played_;
  const Ranges& ranges_;
  ordered_json& table_;
};

ordered_json ToJson(const Played& played, const Ranges& ranges, const Provenance& provenance) {
  ordered_json json = {{"interface", played.interface}};
  if (played.interface == "leg") json["turn_by"] = played.turn_by;
  json.update({{"participants", provenance.participants},
               {"when", provenance.when},
               {"how", provenance.how},
               {"by", provenance.by},
               {"simulated", provenance.simulated},
               {"ranges", ordered_json::object()}});
  for (const auto& [name, range] : ranges) {
    json["ranges"][name] = {{"low", Rounded(range.low)},
                            {"high", Rounded(range.high)},
                            {"seconds", Rounded(range.seconds)}};
  }
  return json;
}

}  // namespace

Result<ordered_json> TableOf(const Played& played, const Ranges& ranges,
                             const Provenance& provenance, const std::string& built_in) {
  ordered_json table = ordered_json::parse(built_in, nullptr, false, true);
  if (!table.is_object()) return InvalidData("the table of " + played.interface + " is not JSON");
  if (const auto filled = Table(played, ranges, table).Fill(); !filled) return filled.error();
  const std::string people = provenance.participants.size() > 1 ? "a group's" : "a person's";
  table["how_found"] = "Borders and ends of " + people +
                       " comfortable range are measured (see measured); all other numbers are the "
                       "built-in ones: " +
                       table.value("how_found", "");
  table["measured"] = ToJson(played, ranges, provenance);
  return table;
}

}  // namespace footing::study::ranges
