#include "clients/study/plan/protocol.h"

#include <algorithm>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/json_text.h"
#include "common/base/text.h"
#include "common/stream/leg_turn.h"
#include "common/stream/user_interface.h"

namespace footing::study::plan {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMostCode = 16;
constexpr std::size_t kMostTracks = 50;
constexpr std::size_t kMostItems = 30;
constexpr std::uint64_t kMostSeed = (1ull << 53) - 1;  // Exact in every JSON reader.
constexpr double kMostPracticeS = 3600;
constexpr double kLeastActiveMin = 0.01, kMostActiveMin = 600;

std::string LowerCase(std::string code) {
  for (char& c : code) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return code;
}

bool Has(const std::vector<std::string>& list, const std::string& one) {
  return std::find(list.begin(), list.end(), one) != list.end();
}

void ReadItems(Reader& reader, Survey& survey) {
  reader.Texts("ratings", survey.ratings, 0, kMostItems);
  reader.Texts("questions", survey.questions, 0, kMostItems);
  reader.Flag("exertion", survey.exertion);
  for (const std::string& item : survey.ratings) {
    if (item == kExertionItem) {
      reader.Fail("ratings", "has \"exertion\", which is a scale of its own: set exertion to true");
    }
    if (Has(survey.questions, item)) {
      reader.Fail("questions", "has \"" + item + "\", which is a rating, too");
    }
  }
}

Result<void> ReadSurvey(Reader& outer, const std::string& file, Survey& survey) {
  const ordered_json* object = outer.Object("survey");
  if (object == nullptr) return {};
  Reader reader(*object, file + ": survey");
  survey = {.ratings = {}, .questions = {}, .exertion = false};
  ReadItems(reader, survey);
  return reader.Finish();
}

Result<void> ReadFinalSurvey(Reader& outer, const std::string& file, FinalSurvey& survey) {
  const ordered_json* object = outer.Object("final_survey");
  if (object == nullptr) return {};
  Reader reader(*object, file + ": final_survey");
  survey.items = {.ratings = {}, .questions = {}, .exertion = false};
  survey.overall.clear();
  ReadItems(reader, survey.items);
  reader.Flag("each_interface", survey.each_interface);
  reader.Texts("overall", survey.overall, 0, kMostItems);
  if (survey.each_interface) return reader.Finish();
  for (const std::string& question : survey.overall) {
    if (!Has(survey.items.ratings, question) && !Has(survey.items.questions, question)) continue;
    reader.Fail("overall",
                "has \"" + question +
                    "\", which is asked about the whole study already: each_interface is "
                    "false");
  }
  return reader.Finish();
}

Result<void> ReadDevices(Reader& outer, const std::string& file, DeviceGate& gate) {
  const ordered_json* object = outer.Object("devices");
  if (object == nullptr) return {};
  Reader reader(*object, file + ": devices");
  reader.Number("least_battery", gate.least_battery, 0, 1);
  reader.Number("least_rate_hz", gate.least_rate_hz, 0, 1000);
  reader.Flag("allow_simulated", gate.allow_simulated);
  return reader.Finish();
}

/// A file's name for each of some interfaces.
Result<void> ReadTables(Reader& outer, const std::string& file, Protocol& protocol) {
  const ordered_json* object = outer.Object("tables");
  if (object == nullptr) return {};
  Reader reader(*object, file + ": tables");
  for (const std::string& interface : protocol.interfaces) {
    std::string path;
    reader.Text(interface, path);
    if (!path.empty()) protocol.settings.tables[interface] = path;
  }
  return reader.Finish();
}

void ReadPeople(Reader& reader, Protocol& protocol) {
  for (const char* key : {"version", "name", "participants", "interfaces", "seed"}) {
    reader.Require(key);
  }
  std::uint64_t version = 1;
  reader.Whole("version", version, 1, 1);
  reader.Text("name", protocol.name);
  reader.Texts("participants", protocol.participants, 1, 1000);
  for (const std::string& code : protocol.participants) {
    if (!IsCode(code)) {
      reader.Fail("participants", "has \"" + code + "\"; " + kCodeRule);
    }
    if (LowerCase(code) == "lock") {
      reader.Fail("participants", "has \"" + code + "\", which is the name of the study's lock");
    }
    for (const std::string& other : protocol.participants) {
      if (other == code || LowerCase(other) != LowerCase(code)) continue;
      reader.Fail("participants", "has \"" + code + "\" and \"" + other +
                                      "\"; codes must differ by more than case");
    }
  }
  reader.Texts("interfaces", protocol.interfaces, 1, stream::kUserInterfaces.size());
  for (const std::string& interface : protocol.interfaces) {
    if (stream::UserInterfaceNamed(interface) == stream::UserInterface::kUnspecified) {
      reader.Fail("interfaces", "has unknown interface \"" + interface +
                                    "\"; there are: " + stream::UserInterfaceNames());
    }
  }
  const bool joystick = Has(protocol.interfaces, "joystick");
  if (!protocol.interfaces.empty()) {
    protocol.control = joystick ? "joystick" : protocol.interfaces.front();
  }
  reader.Text("control", protocol.control);
  if (!Has(protocol.interfaces, protocol.control)) {
    reader.Fail("control", "is \"" + protocol.control + "\", which is not one of interfaces");
  }
  std::string order = Name(protocol.order);
  reader.Text("order", order);
  if (order != "williams" && order != "random") {
    reader.Fail("order", "is \"" + order + "\"; it must be williams or random");
  }
  protocol.order = order == "random" ? Order::kRandom : Order::kWilliams;
  reader.Text("turn_by", protocol.settings.turn_by);
  if (stream::LegTurnSourceNamed(protocol.settings.turn_by) == stream::TurnSource::kUnspecified) {
    reader.Fail("turn_by",
                "is \"" + protocol.settings.turn_by + "\"; it must be head, trunk or feet");
  }
  reader.Whole("seed", protocol.seed, 0, kMostSeed);
  reader.Text("consent", protocol.consent);
}

void ReadTrials(Reader& reader, Protocol& protocol) {
  reader.Number("practice_s", protocol.practice_s, 0, kMostPracticeS);
  reader.Number("rest_s", protocol.rests.between_s, 0, kMostPracticeS);
  reader.Number("active_limit_min", protocol.rests.active_limit_min, kLeastActiveMin,
                kMostActiveMin);
  reader.Number("active_rest_s", protocol.rests.after_limit_s, 0, kMostPracticeS);
  reader.Number("trial_limit_s", protocol.trial_limit_s, 1, kMostPracticeS);
  reader.Text("practice_track", protocol.practice_track);
  reader.Text("straight_track", protocol.straight_track);
  reader.Whole("straight_trials", protocol.straight_trials, 0, 100);
  reader.Texts("straight_tasks", protocol.straight_tasks, 0, kMostTracks);
  reader.Texts("test_tracks", protocol.test_tracks, 0, kMostTracks);
  reader.Number("disk_mb", protocol.disk_mb, 0, 1e6);
}

}  // namespace

bool IsCode(const std::string& code) {
  const auto allowed = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' ||
           c == '_';
  };
  return !code.empty() && code.size() <= kMostCode &&
         std::all_of(code.begin(), code.end(), allowed);
}

const char* Name(Order order) { return order == Order::kWilliams ? "williams" : "random"; }

Result<Protocol> ParseProtocol(const std::string& text, const std::string& file) {
  const auto object = text::ParseOrderedJson(text, file);
  if (!object) return object.error();
  Protocol protocol;
  Reader reader(*object, file);
  ReadPeople(reader, protocol);
  ReadTrials(reader, protocol);
  if (const auto done = ReadSurvey(reader, file, protocol.survey); !done) return done.error();
  if (const auto done = ReadFinalSurvey(reader, file, protocol.final_survey); !done) {
    return done.error();
  }
  reader.Flag("personal_ranges", protocol.settings.personal_ranges);
  reader.Flag("camera_roll", protocol.settings.camera_roll);
  if (protocol.settings.camera_roll && !Has(protocol.interfaces, "leg")) {
    reader.Fail("camera_roll", "is true, and interfaces has no leg, whose picture it rolls");
  }
  if (const auto done = ReadTables(reader, file, protocol); !done) return done.error();
  if (const auto done = ReadDevices(reader, file, protocol.devices); !done) return done.error();
  if (const auto done = reader.Finish(); !done) return done.error();
  return protocol;
}

namespace {

std::string Short(double value) { return ordered_json(value).dump(); }

}  // namespace

Reader::Reader(const ordered_json& object, std::string place)
    : object_(object), place_(std::move(place)) {
  if (!object_.is_object()) fault_ = InvalidData(place_ + ": must be a JSON object");
}

const ordered_json* Reader::Find(const std::string& key) {
  known_.push_back(key);
  if (!object_.is_object()) return nullptr;
  const auto found = object_.find(key);
  return found == object_.end() ? nullptr : &*found;
}

void Reader::Fail(const std::string& key, const std::string& what) {
  if (!fault_) fault_ = InvalidData(place_ + ": " + key + " " + what);
}

void Reader::Wrong(const std::string& key, const ordered_json& value, const std::string& allowed) {
  Fail(key, "is " + text::ToText(value) + "; it must be " + allowed);
}

void Reader::Text(const std::string& key, std::string& value) {
  const ordered_json* found = Find(key);
  if (found == nullptr) return;
  if (!found->is_string()) return Wrong(key, *found, "a text");
  value = found->get<std::string>();
}

void Reader::Flag(const std::string& key, bool& value) {
  const ordered_json* found = Find(key);
  if (found == nullptr) return;
  if (!found->is_boolean()) return Wrong(key, *found, "true or false");
  value = found->get<bool>();
}

void Reader::Number(const std::string& key, double& value, double least, double greatest) {
  const ordered_json* found = Find(key);
  if (found == nullptr) return;
  const double number = found->is_number() ? found->get<double>() : least - 1;
  if (!(number >= least && number <= greatest)) {
    return Wrong(key, *found, "a number from " + Short(least) + " to " + Short(greatest));
  }
  value = number;
}

void Reader::Whole(const std::string& key, std::uint64_t& value, std::uint64_t least,
                   std::uint64_t greatest) {
  const ordered_json* found = Find(key);
  if (found == nullptr) return;
  const bool whole = found->is_number_unsigned();
  const std::uint64_t number = whole ? found->get<std::uint64_t>() : 0;
  if (!whole || number < least || number > greatest) {
    return Wrong(
        key, *found,
        "a whole number from " + std::to_string(least) + " to " + std::to_string(greatest));
  }
  value = number;
}

void Reader::Texts(const std::string& key, std::vector<std::string>& value, std::size_t least,
                   std::size_t greatest) {
  const ordered_json* found = Find(key);
  if (found == nullptr) return;
  const std::string allowed =
      "a list of " + std::to_string(least) + " to " + std::to_string(greatest) + " strings";
  if (!found->is_array() || found->size() < least || found->size() > greatest) {
    return Wrong(key, *found, allowed);
  }
  std::vector<std::string> texts;
  std::set<std::string> seen;
  for (const ordered_json& one : *found) {
    if (!one.is_string()) return Wrong(key, one, allowed);
    texts.push_back(one.get<std::string>());
    if (!seen.insert(texts.back()).second) return Fail(key, "has " + one.dump() + " twice");
  }
  value = std::move(texts);
}

const ordered_json* Reader::Object(const std::string& key) {
  const ordered_json* found = Find(key);
  if (found != nullptr && !found->is_object()) Wrong(key, *found, "an object");
  return found;
}

void Reader::Require(const std::string& key) {
  if (object_.is_object() && !object_.contains(key)) Fail(key, "is missing");
}

Result<void> Reader::Finish() {
  if (object_.is_object()) {
    for (const auto& [key, value] : object_.items()) {
      if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
      // A misspelt key is more to the point than what is missing for it.
      return InvalidData(place_ + ": unknown key \"" + key +
                         "\"; there are: " + text::Joined(known_));
    }
  }
  if (fault_) return *fault_;
  return {};
}

namespace {

std::vector<SurveyItem> ItemsOf(const Survey& survey, const std::vector<std::string>& interfaces,
                                bool at_end) {
  std::vector<SurveyItem> items;
  const auto add = [&](const std::string& item, SurveyScale scale) {
    for (const std::string& interface : interfaces) {
      items.push_back({interface, item, scale, at_end});
    }
  };
  for (const std::string& item : survey.ratings) add(item, SurveyScale::kRating);
  if (survey.exertion) add(kExertionItem, SurveyScale::kExertion);
  for (const std::string& question : survey.questions) add(question, SurveyScale::kText);
  return items;
}

}  // namespace

std::vector<SurveyItem> ItemsAfter(const Protocol& protocol, const std::string& interface) {
  return ItemsOf(protocol.survey, {interface}, /*at_end=*/false);
}

std::vector<SurveyItem> ItemsAtEnd(const Protocol& protocol,
                                   const std::vector<std::string>& interfaces) {
  const FinalSurvey& survey = protocol.final_survey;
  const std::vector<std::string> whole_study = {""};
  std::vector<SurveyItem> items =
      ItemsOf(survey.items, survey.each_interface ? interfaces : whole_study, /*at_end=*/true);
  for (const std::string& question : survey.overall) {
    if (question == kPreferredItem) {
      items.push_back({"", question, SurveyScale::kChoice, true, interfaces});
      continue;
    }
    items.push_back({"", question, SurveyScale::kText, true});
  }
  return items;
}

}  // namespace footing::study::plan
