#include "clients/study/study_tables.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "clients/study/plan/phases.h"
#include "common/base/json_text.h"
#include "common/base/text.h"
#include "common/recording/bids_tables.h"
#include "common/stream/trial.h"

namespace footing::study::bundle {
namespace {

constexpr const char* kHeader = "number,code";

}  // namespace

Result<ParticipantKey> ParticipantKey::Parse(std::string_view text, const std::string& file) {
  text::Lines lines(text, file);
  const auto header = lines.NextFull();
  if (!header || *header != kHeader) {
    return lines.Fault(std::string("the first line must be \"") + kHeader + "\"");
  }
  ParticipantKey key;
  std::map<std::size_t, bool> taken;
  while (const auto line = lines.NextFull()) {
    const auto cells = text::Cells(*line);
    const auto number = cells.size() == 2 ? text::ToCount(cells[0]) : std::nullopt;
    if (!number || *number == 0) return lines.Fault("it must have a number and a code");
    const bool fresh = taken.emplace(*number, true).second &&
                       key.number_of_.emplace(std::string(cells[1]), *number).second;
    if (!fresh) return lines.Fault("its number or its code stands above, too");
  }
  return key;
}

void ParticipantKey::Add(std::vector<std::string> codes, std::uint64_t seed) {
  std::erase_if(codes, [this](const std::string& code) { return number_of_.count(code) != 0; });
  plan::Draw(seed, "numbers of participants").Shuffle(codes);
  std::size_t last = 0;
  for (const auto& [code, number] : number_of_) last = std::max(last, number);
  for (const std::string& code : codes) number_of_[code] = ++last;
}

std::string ParticipantKey::SubjectOf(const std::string& code) const {
  const std::string number = std::to_string(number_of_.at(code));
  return "sub-" + (number.size() < 2 ? "0" + number : number);
}

std::string ParticipantKey::Text() const {
  std::string text = std::string(kHeader) + "\n";
  for (const auto& [code, number] : number_of_) text += std::to_string(number) + "," + code + "\n";
  return text;
}

namespace {

using bids::Column;
using bids::Tsv;
using nlohmann::ordered_json;
using records::Records;
using records::Trial;
using Rows = std::vector<std::vector<std::string>>;

/// Empty, which becomes "n/a", where there is no number.
std::string Cell(double value, int decimals) {
  return std::isfinite(value) ? text::Fixed(value, decimals) : "";
}

std::string YesOrNo(bool yes) { return yes ? "yes" : "no"; }

/// First part of a survey column's name: "wrist", at the end "final_wrist", "final" of the whole
/// study.
template <typename Answered>
std::string About(const Answered& one) {
  if (one.interface.empty()) return "final";
  return (one.at_end ? "final_" : "") + one.interface;
}

/// "wrist_ease_of_use".
std::string ColumnOf(const std::string& about, const std::string& item) {
  std::string name = about + "_" + item;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

/// Different items have different columns, also where their names differ only in what ColumnOf
/// replaces: the second one is NAME_2. The codebook has the items as they were asked.
class ColumnNames {
 public:
  std::string Of(const std::string& about, const std::string& item, const char* form) {
    const auto known = names_.find({about, item, form});
    if (known != names_.end()) return known->second;
    const std::string plain = ColumnOf(about, item);
    std::string name = plain;
    for (int i = 2; !used_.insert(name).second; ++i) name = plain + "_" + std::to_string(i);
    return names_[{about, item, form}] = name;
  }

 private:
  std::map<std::tuple<std::string, std::string, std::string>, std::string> names_;
  std::set<std::string> used_;
};

template <typename Answered>
std::string WhenAsked(const Answered& one) {
  if (one.interface.empty()) return "asked at the end about the whole study";
  return (one.at_end ? "asked at the end about the interface " : "asked after the interface ") +
         one.interface;
}

}  // namespace

DocumentedTable ParticipantsTable(const std::vector<Records>& people, const ParticipantKey& key) {
  Rows rows = {{"participant_id", "interface_order", "finished", "synthetic", "time_in_motion"}};
  for (const Records& person : people) {
    std::string order;
    for (const std::string& one : person.interfaces) order += (order.empty() ? "" : " ") + one;
    double active_s = 0;
    for (const auto& [interface, seconds] : person.active_s) active_s += seconds;
    rows.push_back({key.SubjectOf(person.participant), order, YesOrNo(person.finished),
                    YesOrNo(person.synthetic), Cell(active_s, 1)});
  }
  std::sort(rows.begin() + 1, rows.end());
  return {Tsv(rows),
          {{"interface_order", Column("Interfaces in the order in which they were used")},
           {"finished", Column("The session came to its end: yes or no")},
           {"synthetic", Column("yes: simulated devices or random answers, not a person")},
           {"time_in_motion",
            Column("How long a controller on the body moved during practice and trials", "s")}}};
}

DocumentedTable SurveyTable(const std::vector<Records>& people, const ParticipantKey& key,
                            bool with_text) {
  std::vector<std::string> columns;
  DocumentedTable table;
  ColumnNames names;
  std::map<std::string, std::map<std::string, std::string>> cells;  // By subject and column.
  const auto add = [&](const std::string& subject, const std::string& column, std::string cell,
                       const ordered_json& meaning) {
    if (!table.codebook.contains(column)) columns.push_back(column);
    table.codebook[column] = meaning;
    cells[subject][column] = std::move(cell);
  };
  for (const Records& person : people) {
    const std::string subject = key.SubjectOf(person.participant);
    cells[subject];
    for (const records::Rating& one : person.ratings) {
      const std::string scale = one.item == "exertion"
                                    ? ", 0 (nothing at all) to 10 (extremely strong)"
                                    : ", 1 (very little) to 5 (very much)";
      add(subject, names.Of(About(one), one.item, "rating"), Cell(one.value, 0),
          Column(one.item + scale + "; " + WhenAsked(one)));
    }
    if (!with_text) continue;
    for (const records::Answer& one : person.answers) {
      add(subject, names.Of(About(one), one.question, "text"), one.text,
          Column("Free text: " + one.question + "; " + WhenAsked(one)));
    }
  }
  Rows rows = {{"participant_id"}};
  std::sort(columns.begin(), columns.end());
  rows[0].insert(rows[0].end(), columns.begin(), columns.end());
  for (auto& [subject, own] : cells) {
    std::vector<std::string>& row = rows.emplace_back();
    row.push_back(subject);
    for (const std::string& column : columns) row.push_back(own[column]);
  }
  table.tsv = Tsv(rows);
  return table;
}

DocumentedTable TrialsTable(const std::vector<Records>& people, const ParticipantKey& key,
                            const std::map<const Trial*, std::string>& file_of) {
  DocumentedTable table;
  table.codebook = {
      {"interface", Column("Interface by which the character was controlled")},
      {"position", Column("Position of the interface in the participant's order, from 1")},
      {"kind", Column("straight: straight track with a task; test_track: curves and pits")},
      {"track", Column("Built-in track of Footing")},
      {"task", Column("Task of the straight track: gait before and after the line")},
      {"attempt", Column("Attempt at this trial, from 1")},
      {"outcome", Column("finished, timed_out, stopped, device_lost, broken_off, interrupted")},
      {"counts", Column("yes: the last attempt that ended, the one to analyse")},
      {"time_s", Column("From the start line, including put-backs", "s")},
      {"distance_m", Column("Along the track", "m")},
      {"time_to_first_failure_s", Column("From the start line", "s")},
      {"heading_oscillation_rad", Column("Standard deviation of the heading error", "rad")},
      {"anticipation_s", Column("Command before the character reached the line of the task", "s")},
      {"file", Column("Stem of the motion files")}};
  for (const stream::FailureCause cause : stream::kFailureCauses) {
    const std::string name = stream::Name(cause);
    table.codebook["failures_" + name] = Column("Failures of kind " + name + " that count");
  }
  Rows rows = {{"participant_id"}};
  for (const auto& [name, meaning] : table.codebook.items()) rows[0].push_back(name);
  for (const Records& person : people) {
    const auto counting = records::Counting(person);
    for (const Trial& trial : person.trials) {
      const bool counts = std::find(counting.begin(), counting.end(), &trial) != counting.end();
      const auto file = file_of.find(&trial);
      std::vector<std::string> row = {key.SubjectOf(person.participant),
                                      trial.interface,
                                      std::to_string(trial.position),
                                      trial.kind,
                                      trial.track,
                                      trial.task,
                                      std::to_string(trial.attempt),
                                      trial.outcome,
                                      YesOrNo(counts),
                                      Cell(trial.time_s, 3),
                                      Cell(trial.distance_m, 3),
                                      Cell(trial.time_to_first_failure_s(), 3),
                                      Cell(trial.heading_oscillation_rad, 5),
                                      Cell(trial.anticipation_s, 3),
                                      file == file_of.end() ? "" : file->second};
      for (const stream::FailureCause cause : stream::kFailureCauses) {
        row.push_back(std::to_string(trial.Count(stream::Name(cause))));
      }
      rows.push_back(std::move(row));
    }
  }
  std::stable_sort(rows.begin() + 1, rows.end(),
                   [](const auto& a, const auto& b) { return a[0] < b[0]; });
  table.tsv = Tsv(rows);
  return table;
}

namespace {

std::string IdOf(const recording::RecordedSession& session) {
  for (const mcap::Metadata& one : session.metadata()) {
    const auto id = one.values.find("trial");
    if (one.name == "trial" && id != one.values.end()) return id->second;
  }
  return "";
}

}  // namespace

Result<bids::RecordedMotion> ReadTrial(const recording::RecordedSession& session,
                                       const records::Trial& trial) {
  bids::Choice choice{IdOf(session), {}, /*with_role=*/true};
  if (choice.trial.empty()) return InvalidData(session.path() + ": it has no trial marks");
  if (session.Find("footing-sim") == nullptr) {
    return InvalidData(session.path() + " has no messages of footing-sim");
  }
  for (const records::Failure& one : trial.failures) {
    if (one.undone) choice.undone.insert(one.number);
  }
  return ReadMotion(session, choice);
}

namespace {

/// An allow-list: a key that a later footing-sim adds stays out until somebody has checked it.
ordered_json Only(const ordered_json& object, std::initializer_list<const char*> keys) {
  ordered_json kept = ordered_json::object();
  for (const char* key : keys) {
    if (object.is_object() && object.contains(key)) kept[key] = object[key];
  }
  return kept;
}

ordered_json AnonymousTable(ordered_json table) {
  if (!table.is_object() || !table.contains("measured")) return table;
  table["measured"] =
      Only(table["measured"], {"interface", "turn_by", "by", "simulated", "ranges"});
  return table;
}

}  // namespace

ordered_json AnonymousConfig(const std::string& json, const std::string& sensor_json) {
  const ordered_json config = ordered_json::parse(json, nullptr, /*allow_exceptions=*/false);
  if (!config.is_object()) return nullptr;
  ordered_json kept = Only(config, {"program", "version", "engine", "step_s", "sha256"});
  kept["features"] = text::SettingIn(sensor_json, "features").value_or("best");
  if (config.contains("settings")) {
    kept["settings"] =
        Only(config["settings"],
             {"gaits", "turn_by", "camera_roll", "boards_may_be_left", "frame_rate_hz",
              "features_timeout_s", "fall_shown_s", "put_back_distance_m"});
  }
  if (!config.contains("interface")) return kept;
  const ordered_json& interface = config["interface"];
  kept["interface"] = Only(interface, {"name", "turn_by", "camera_roll", "boards_may_be_left"});
  if (interface.is_object() && interface.contains("table")) {
    kept["interface"]["table"] = AnonymousTable(interface["table"]);
  }
  return kept;
}

}  // namespace footing::study::bundle
