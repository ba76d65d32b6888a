#include "common/base/json_text.h"

#include <set>
#include <vector>

#include "common/base/text.h"

namespace footing::text {
namespace {

/// Follows a parser through a text and keeps the first key that one object has twice.
template <typename Json>
class RepeatedKey {
 public:
  bool operator()(int /*depth*/, typename Json::parse_event_t event, Json& parsed) {
    switch (event) {
      case Json::parse_event_t::object_start:
        open_.emplace_back();
        break;
      case Json::parse_event_t::object_end:
        open_.pop_back();
        break;
      case Json::parse_event_t::key: {
        const auto& key = parsed.template get_ref<const std::string&>();
        if (!open_.back().insert(key).second && name_.empty()) name_ = Quoted(key);
        break;
      }
      default:
        break;
    }
    return true;
  }

  /// Empty for none.
  const std::string& name() const { return name_; }

 private:
  std::vector<std::set<std::string>> open_;
  std::string name_;
};

template <typename Json>
Result<Json> Parse(const std::string& text, const std::string& origin) {
  RepeatedKey<Json> repeated;
  Json json;
  try {
    json = Json::parse(text, std::ref(repeated), true, /*ignore_comments=*/true);
  } catch (const typename Json::exception& error) {  // Also for too large a number.
    return InvalidData(origin + " is not JSON: " + std::string(WithoutTag(error.what())));
  }
  if (!repeated.name().empty()) {
    return InvalidData(origin + " has the key " + repeated.name() +
                       " twice in one object; leave one of them out");
  }
  return json;
}

}  // namespace

Result<nlohmann::json> ParseJson(const std::string& text, const std::string& origin) {
  return Parse<nlohmann::json>(text, origin);
}

Result<nlohmann::ordered_json> ParseOrderedJson(const std::string& text,
                                                const std::string& origin) {
  return Parse<nlohmann::ordered_json>(text, origin);
}

std::optional<std::string> SettingIn(const std::string& effective_config, const std::string& key) {
  const auto json = nlohmann::json::parse(effective_config, nullptr, false);
  const auto setting = nlohmann::json::json_pointer("/settings/" + key);
  if (!json.contains(setting) || !json[setting].is_string()) return std::nullopt;
  return json[setting].get<std::string>();
}

}  // namespace footing::text
