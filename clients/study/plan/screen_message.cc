#include "clients/study/plan/screen_message.h"

#include <nlohmann/json.hpp>

#include "common/base/text.h"

namespace footing::study::screen {
namespace {

using nlohmann::ordered_json;

constexpr auto kReplace = ordered_json::error_handler_t::replace;

}  // namespace

std::string ToText(const Shown& shown) {
  return ordered_json{
      {"number", shown.number},     {"title", shown.title}, {"item", shown.item},
      {"scale", shown.scale},       {"least", shown.least}, {"greatest", shown.greatest},
      {"position", shown.position}, {"count", shown.count}, {"choices", shown.choices}}
      .dump(-1, ' ', false, kReplace);
}

std::string ToText(const Reply& reply) {
  return ordered_json{{"number", reply.number}, {"text", reply.text}}.dump(-1, ' ', false,
                                                                           kReplace);
}

Result<Shown> ParseShown(std::string_view text) {
  try {
    const ordered_json json = ordered_json::parse(text);
    return Shown{.number = json.at("number"),
                 .title = json.at("title"),
                 .item = json.at("item"),
                 .scale = json.at("scale"),
                 .least = json.at("least"),
                 .greatest = json.at("greatest"),
                 .position = json.at("position"),
                 .count = json.at("count"),
                 .choices = json.value("choices", std::vector<std::string>())};
  } catch (const ordered_json::exception& error) {
    return InvalidData(std::string("not a question: ") + error.what());
  }
}

Result<Reply> ParseReply(std::string_view text) {
  try {
    const ordered_json json = ordered_json::parse(text);
    return Reply{json.at("number"), json.at("text")};
  } catch (const ordered_json::exception& error) {
    return InvalidData(std::string("not an answer: ") + error.what());
  }
}

std::optional<int> ParseRating(const std::string& text, int least, int greatest) {
  const auto first = text.find_first_not_of(" \t");
  const auto last = text.find_last_not_of(" \t");
  if (first == std::string::npos) return std::nullopt;
  const auto value = text::ToCount(text.substr(first, last - first + 1));
  if (!value || *value > static_cast<std::size_t>(greatest)) return std::nullopt;
  const int rating = static_cast<int>(*value);
  return rating < least ? std::nullopt : std::optional(rating);
}

std::optional<std::string> ParseChoice(const std::string& text,
                                       const std::vector<std::string>& choices) {
  const std::string_view word = text::Trim(text);
  for (const std::string& choice : choices) {
    if (text::EqualsIgnoringCase(word, choice)) return choice;
  }
  const auto number = text::ToCount(word);
  if (!number || *number < 1 || *number > choices.size()) return std::nullopt;
  return choices[*number - 1];
}

std::string ChoiceLine(const std::vector<std::string>& choices) {
  std::string line;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    line += (i == 0 ? "" : "   ") + std::to_string(i + 1) + " " + choices[i];
  }
  return line;
}

bool Answers(const Shown& shown, const std::string& text) {
  if (!shown.choices.empty()) return ParseChoice(text, shown.choices).has_value();
  return !shown.is_rating() || ParseRating(text, shown.least, shown.greatest).has_value();
}

}  // namespace footing::study::screen
