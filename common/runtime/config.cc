#include "common/runtime/config.h"

#include <cstddef>
#include <iterator>
#include <sstream>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/json_text.h"
#include "common/base/text.h"
#include "common/runtime/files.h"

namespace footing::config {
namespace {

using Json = nlohmann::ordered_json;

std::string Range(const std::string& min, const std::string& max) {
  return "from " + min + " to " + max;
}

std::string NumberText(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

}  // namespace

void Binder::Number(const std::string& key, double& value, double min, double max,
                    const std::string& documentation) {
  auto assign = [&value, min, max](const Json& json) {
    if (!json.is_number()) return false;
    const double number = json.get<double>();
    if (!(number >= min && number <= max)) return false;
    value = number;
    return true;
  };
  entries_.push_back({key, "a number " + Range(NumberText(min), NumberText(max)), documentation,
                      assign, [&value] { return Json(value); }});
}

void Binder::Integer(const std::string& key, std::int64_t& value, std::int64_t min,
                     std::int64_t max, const std::string& documentation) {
  auto assign = [&value, min, max](const Json& json) {
    if (!json.is_number_integer()) return false;
    const auto number = json.get<std::int64_t>();
    if (number < min || number > max) return false;
    value = number;
    return true;
  };
  entries_.push_back({key, "a whole number " + Range(std::to_string(min), std::to_string(max)),
                      documentation, assign, [&value] { return Json(value); }});
}

void Binder::Flag(const std::string& key, bool& value, const std::string& documentation) {
  auto assign = [&value](const Json& json) {
    if (!json.is_boolean()) return false;
    value = json.get<bool>();
    return true;
  };
  entries_.push_back(
      {key, "true or false", documentation, assign, [&value] { return Json(value); }});
}

void Binder::Text(const std::string& key, std::string& value, const std::string& documentation) {
  auto assign = [&value](const Json& json) {
    if (!json.is_string()) return false;
    value = json.get<std::string>();
    return true;
  };
  entries_.push_back(
      {key, "a text", documentation, assign, [&value] { return Json(value); }, true});
}

void Binder::TextList(const std::string& key, std::vector<std::string>& value,
                      const std::string& documentation) {
  auto assign = [&value](const Json& json) {
    if (!json.is_array()) return false;
    std::vector<std::string> list;
    for (const Json& item : json) {
      if (!item.is_string()) return false;
      list.push_back(item.get<std::string>());
    }
    value = std::move(list);
    return true;
  };
  entries_.push_back(
      {key, "a list of strings", documentation, assign, [&value] { return Json(value); }});
}

void Binder::TextMap(const std::string& key, std::map<std::string, std::string>& value,
                     const std::string& documentation,
                     std::function<std::string(const std::string&)> check) {
  auto why = [check = std::move(check)](const Json& json) -> std::string {
    if (!json.is_object()) return "";
    for (const auto& [name, item] : json.items()) {
      const std::string problem = item.is_string() ? check(item.get<std::string>()) : "";
      if (!problem.empty()) return text::Quoted(name) + ": " + problem;
    }
    return "";
  };
  auto assign = [&value, why](const Json& json) {
    if (!json.is_object() || !why(json).empty()) return false;
    std::map<std::string, std::string> map;
    for (const auto& [name, item] : json.items()) {
      if (!item.is_string()) return false;
      map[name] = item.get<std::string>();
    }
    value = std::move(map);
    return true;
  };
  entries_.push_back({key, "an object of strings (" + documentation + ")", documentation, assign,
                      [&value] { return Json(value); }});
  entries_.back().why = why;
}

const Binder::Entry* Binder::Find(const std::string& key) const {
  for (const Entry& entry : entries_) {
    if (entry.key == key) return &entry;
  }
  return nullptr;
}

Binder::Entry* Binder::Find(const std::string& key) {
  for (Entry& entry : entries_) {
    if (entry.key == key) return &entry;
  }
  return nullptr;
}

/// Where a user finds the keys: a program prints those of its config.
std::string Binder::AllKeys() const {
  if (what_ == "config") return "--print-config lists the keys";
  std::string keys = "there are:";
  for (const Entry& entry : entries_) keys += (keys.ends_with(':') ? " " : ", ") + entry.key;
  return keys;
}

Result<void> Binder::Assign(const std::string& key, const Json& value, const std::string& where,
                            const std::string& origin) {
  Entry* entry = Find(key);
  if (entry == nullptr) {
    return UsageError(what_ + ": unknown key \"" + key + "\" in " + where + "; " + AllKeys());
  }
  if (!entry->assign(value)) {
    if (const std::string why = entry->why ? entry->why(value) : ""; !why.empty()) {
      return UsageError(what_ + ": " + key + " in " + where + ": " + why);
    }
    const std::string shown = value.dump(-1, ' ', false, Json::error_handler_t::replace);
    return UsageError(what_ + ": " + key + " = " + shown + " in " + where + "; it must be " +
                      entry->allowed);
  }
  entry->origin = origin;
  return {};
}

Result<void> Binder::ApplyText(const std::string& text, const std::string& origin) {
  const auto json = text::ParseOrderedJson(text, origin);
  if (!json) return UsageError(what_ + ": " + json.error().message);
  if (!json->is_object()) return UsageError(what_ + ": " + origin + " must hold one JSON object");
  const auto lines = LinesOfKeys(text);
  for (const auto& [key, value] : json->items()) {
    const auto line = lines.find(key);
    const std::string place =
        line == lines.end() ? origin : origin + ":" + std::to_string(line->second);
    if (const Result<void> result = Assign(key, value, origin, place); !result) return result;
  }
  return {};
}

Result<void> Binder::ApplyFile(const std::string& path) {
  const Result<std::string> text = ReadTextFile(path, 1u << 20);
  if (!text) return UsageError(what_ + ": " + text.error().message);
  return ApplyText(*text, path);
}

Result<void> Binder::ApplySetting(const std::string& setting, const std::string& option) {
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos || equals == 0) {
    return UsageError(option + " " + setting + ": write it as key=value");
  }
  const std::string key = setting.substr(0, equals);
  const std::string text = setting.substr(equals + 1);
  const Entry* entry = Find(key);
  Json value = Json::parse(text, nullptr, false);
  if (value.is_discarded() || (entry != nullptr && entry->text && !value.is_string())) {
    if (!text::IsUtf8(text))
      return UsageError(option + " " + key + ": its value is not text in UTF-8");
    value = text;
  }
  return Assign(key, value, option, option);
}

Result<void> Binder::Apply(const std::string& file, const std::vector<std::string>& settings) {
  if (!file.empty()) {
    if (const auto applied = ApplyFile(file); !applied) return applied;
  }
  for (const std::string& setting : settings) {
    if (const auto applied = ApplySetting(setting); !applied) return applied;
  }
  return {};
}

std::string Binder::Print() const {
  Json json = Json::object();
  for (const Entry& entry : entries_) json[entry.key] = entry.read();
  return json.dump(2);
}

std::string Binder::PrintOrigins() const {
  std::string text;
  for (const Entry& entry : entries_) {
    const Json one{{"value", entry.read()}, {"origin", entry.origin}};
    text += (text.empty() ? "{\n  " : ",\n  ") + Json(entry.key).dump() + ": " + one.dump();
  }
  return text + "\n}";
}

std::string Binder::Describe() const {
  std::string text;
  for (const Entry& entry : entries_) {
    text += entry.key + ": " + entry.documentation + " (" + entry.allowed + "; " +
            entry.read().dump() + ")\n";
  }
  return text;
}

std::vector<Change> Differences(const Binder& before, const Binder& after) {
  const Json old_values = Json::parse(before.Print()), new_values = Json::parse(after.Print());
  std::vector<Change> changes;
  for (const auto& [key, value] : new_values.items()) {
    const std::string old_text = old_values.contains(key) ? old_values[key].dump() : "";
    if (old_text != value.dump()) changes.push_back({key, old_text, value.dump()});
  }
  return changes;
}

namespace {

/// Goes over a text and counts the lines that it has passed; copies count together.
class LineCounter {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  LineCounter(const char* at, int* line) : at_(at), line_(line) {}

  reference operator*() const { return *at_; }
  LineCounter& operator++() {
    if (*at_ == '\n') ++*line_;
    ++at_;
    return *this;
  }
  LineCounter operator++(int) {
    const LineCounter before = *this;
    ++*this;
    return before;
  }
  bool operator==(const LineCounter& other) const { return at_ == other.at_; }
  bool operator!=(const LineCounter& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  int* line_;
};

/// Notes the keys of the outermost object as the parser comes by.
class KeyNotes : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit KeyNotes(const int& line) : line_(line) {}

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return Deeper(1); }
  bool end_object() override { return Deeper(-1); }
  bool start_array(std::size_t) override { return Deeper(1); }
  bool end_array() override { return Deeper(-1); }
  bool key(string_t& name) override {
    if (depth_ == 1) lines_[name] = line_;
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception&) override {
    return false;
  }

  const std::map<std::string, int>& lines() const { return lines_; }

 private:
  bool Deeper(int by) {
    depth_ += by;
    return true;
  }

  const int& line_;
  int depth_ = 0;
  std::map<std::string, int> lines_;
};

}  // namespace

std::map<std::string, int> LinesOfKeys(const std::string& text) {
  int line = 1;
  KeyNotes notes(line);
  nlohmann::json::sax_parse(LineCounter(text.data(), &line),
                            LineCounter(text.data() + text.size(), &line), &notes,
                            nlohmann::detail::input_format_t::json, true, true);
  return notes.lines();
}

namespace {

std::string Listed(const std::vector<Change>& changes) {
  std::string text;
  for (const Change& change : changes) {
    text += (text.empty() ? "" : ", ") + change.key + " " + change.before + " -> " + change.after;
  }
  return text;
}

}  // namespace

std::vector<std::string> DescribeReload(const Binder& before, const Binder& after,
                                        const Binder& wanted,
                                        const std::vector<std::string>& files) {
  const auto taken = Differences(before, after), left = Differences(after, wanted);
  std::string now = Listed(taken);
  for (const std::string& file : files) now += (now.empty() ? "" : ", ") + ("contents of " + file);
  std::vector<std::string> lines;
  if (!now.empty()) lines.push_back("config reloaded: " + now);
  if (!left.empty()) lines.push_back("config: takes effect after a restart: " + Listed(left));
  if (lines.empty()) lines.push_back("config reloaded: nothing has changed");
  return lines;
}

}  // namespace footing::config
