#include "clients/study/plan/reader.h"

#include "common/base/joined.h"
#include "common/base/json_text.h"

#include <algorithm>
#include <set>
#include <utility>

namespace footing::study::plan {
namespace {

using nlohmann::ordered_json;

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

}  // namespace footing::study::plan
