#include "clients/study/session/survey.h"

#include <optional>
#include <utility>

#include "clients/study/session/respondent.h"
#include "clients/study/session/survey_screen.h"

namespace footing::study {
namespace {

using nlohmann::ordered_json;
using records::EventKind;
using screen::Shown;

constexpr int kLeastRating = 1;
constexpr int kMostRating = 5;
constexpr int kMostExertion = 10;  // Borg's CR10 scale.
constexpr const char* kRatingScale = "1 very little, 5 very much";
constexpr const char* kExertionScale = "0 nothing at all, 10 extremely strong";
constexpr double kAnswerWithinS = 24 * 3600;  // A wait for a person has no end worth naming.
/// Asks here in place of the participant's screen.
constexpr char kHereKey = 't';

class SurveyRun {
 public:
  SurveyRun(SessionContext& context, const std::string& interface, int count)
      : context_(context),
        interface_(interface),
        respondent_{context.options.answer_seed, context.session.participant},
        count_(count) {}

  Result<void> Rating(EventKind kind, const std::string& item, const std::string& scale, int least,
                      int greatest) {
    ++position_;
    int value = 0;
    if (context_.options.unattended) {
      value = respondent_.Rate(interface_, item, least, greatest);
    } else {
      const auto asked = Ask(Question(item, scale, least, greatest));
      if (!asked) return asked.error();
      value = *screen::ParseRating(*asked, least, greatest);
    }
    return Append(kind, {{"item", item}, {"value", value}});
  }

  Result<void> Text(const std::string& question) {
    ++position_;
    std::string text;
    if (context_.options.unattended) {
      text = respondent_.Answer(interface_, question);
    } else {
      auto asked = Ask(Question(question, "", 0, 0));
      if (!asked) return asked.error();
      text = std::move(*asked);
    }
    return Append(EventKind::kAnswer, {{"question", question}, {"text", text}});
  }

 private:
  Shown Question(const std::string& item, const std::string& scale, int least, int greatest) const {
    return {.title = interface_.empty() ? "The whole study" : "Interface " + interface_,
            .item = item,
            .scale = scale,
            .least = least,
            .greatest = greatest,
            .position = position_,
            .count = count_};
  }

  Result<std::string> Ask(const Shown& question) {
    if (context_.screen != nullptr && !here_) {
      auto answer = AskOnScreen(question);
      if (!answer) return answer.error();
      if (*answer) return std::move(**answer);
      here_ = true;
    }
    return AskHere(question);
  }

  /// Nothing: the experimenter wants to ask in the terminal.
  Result<std::optional<std::string>> AskOnScreen(const Shown& question) {
    Console& console = context_.console;
    SurveyScreen& screen = *context_.screen;
    screen.Ask(question);
    std::string text = "  " + question.item + ": on the participant's screen";
    if (!screen.connected()) {
      text += ", which is not there yet: footing-study survey --connect " + screen.address().Text();
    }
    console.ReadKeys(true);
    console.Print(text + ". Press " + kHereKey + " to ask here.");
    std::optional<std::string> answer;
    std::optional<char> key;
    const Waited waited = console.RunUntil(
        [&] {
          answer = screen.TakeAnswer();
          key = console.TakeKey();
          return answer || key == kHereKey;
        },
        kAnswerWithinS);
    console.ReadKeys(false);
    if (waited == Waited::kInterrupted) return Interrupted();
    if (answer) return answer;
    screen.Say("Please answer the experimenter.");
    return std::optional<std::string>();
  }

  Result<std::string> AskHere(const Shown& question) {
    const std::string range =
        std::to_string(question.least) + " to " + std::to_string(question.greatest);
    const bool exertion = question.greatest == kMostExertion;
    const std::string prompt =
        question.is_rating()
            ? question.item + (exertion ? " (" + question.scale + ")" : "") + ", " + range + ":"
            : question.item + " (one line):";
    for (;;) {
      auto text = context_.console.Ask("  " + prompt);
      if (!text || screen::Answers(question, *text)) return text;
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
  int count_ = 0;
  int position_ = 0;
  bool here_ = false;  ///< The experimenter asks in the terminal.
};

Result<void> AskAll(SessionContext& context, const plan::Survey& survey,
                    const std::string& interface) {
  const std::size_t count =
      survey.ratings.size() + survey.questions.size() + (survey.exertion ? 1 : 0);
  SurveyRun run(context, interface, static_cast<int>(count));
  for (const std::string& item : survey.ratings) {
    const auto done = run.Rating(EventKind::kRating, item, kRatingScale, kLeastRating, kMostRating);
    if (!done) return done;
  }
  if (survey.exertion) {
    const auto done =
        run.Rating(EventKind::kExertion, "exertion", kExertionScale, 0, kMostExertion);
    if (!done) return done;
  }
  for (const std::string& question : survey.questions) {
    if (const auto done = run.Text(question); !done) return done;
  }
  return {};
}

}  // namespace

Result<void> RunSurvey(SessionContext& context, const plan::Survey& survey,
                       const std::string& interface) {
  if (!context.options.unattended) {
    context.console.Print("Survey" + (interface.empty() ? "" : ", interface " + interface) + ": " +
                          kRatingScale + ".");
  }
  const auto done = AskAll(context, survey, interface);
  if (context.screen != nullptr) context.screen->Say("Thank you. Please wait.");
  return done;
}

}  // namespace footing::study
