#include "clients/study/session/survey.h"

#include "clients/study/session/respondent.h"
#include "common/text/number.h"

namespace footing::study {
namespace {

using nlohmann::ordered_json;
using records::EventKind;

constexpr int kLeastRating = 1;
constexpr int kMostRating = 5;
constexpr int kMostExertion = 10;  // Borg's CR10 scale.

class SurveyRun {
 public:
  SurveyRun(SessionContext& context, const std::string& interface)
      : context_(context),
        interface_(interface),
        respondent_{context.options.answer_seed, context.session.participant} {}

  Result<void> Rating(EventKind kind, const std::string& item, const std::string& scale, int least,
                      int greatest) {
    int value = 0;
    if (context_.options.unattended) {
      value = respondent_.Rate(interface_, item, least, greatest);
    } else {
      const auto asked = Ask(item + scale, least, greatest);
      if (!asked) return asked.error();
      value = *asked;
    }
    return Append(kind, {{"item", item}, {"value", value}});
  }

  Result<void> Question(const std::string& question) {
    std::string text;
    if (context_.options.unattended) {
      text = respondent_.Answer(interface_, question);
    } else {
      auto asked = context_.console.Ask("  " + question + " (one line):");
      if (!asked) return asked.error();
      text = std::move(*asked);
    }
    return Append(EventKind::kAnswer, {{"question", question}, {"text", text}});
  }

 private:
  Result<int> Ask(const std::string& item, int least, int greatest) {
    const std::string range = std::to_string(least) + " to " + std::to_string(greatest);
    for (;;) {
      const auto text = context_.console.Ask("  " + item + ", " + range + ":");
      if (!text) return text.error();
      if (const auto value = ParseRating(*text, least, greatest)) return *value;
      context_.console.Print("  Type a whole number from " + range + ".");
    }
  }

  Result<void> Append(EventKind kind, ordered_json fields) {
    fields["interface"] = interface_;
    fields["synthetic"] = context_.options.unattended;
    return context_.journal.Append(kind, std::move(fields));
  }

  SessionContext& context_;
  const std::string& interface_;
  Respondent respondent_;
};

}  // namespace

Result<void> RunSurvey(SessionContext& context, const plan::Survey& survey,
                       const std::string& interface) {
  SurveyRun run(context, interface);
  if (!context.options.unattended) {
    context.console.Print("Survey" + (interface.empty() ? "" : ", interface " + interface) +
                          ": 1 is very little, 5 is very much.");
  }
  for (const std::string& item : survey.ratings) {
    const auto done = run.Rating(EventKind::kRating, item, "", kLeastRating, kMostRating);
    if (!done) return done;
  }
  if (survey.exertion) {
    const auto done = run.Rating(EventKind::kExertion, "exertion",
                                 " (0 nothing at all, 10 extremely strong)", 0, kMostExertion);
    if (!done) return done;
  }
  for (const std::string& question : survey.questions) {
    if (const auto done = run.Question(question); !done) return done;
  }
  return {};
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

}  // namespace footing::study
