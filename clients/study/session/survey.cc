#include "clients/study/session/survey.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "clients/study/plan/phases.h"
#include "clients/study/report/event.h"

namespace footing::study {
namespace {

using nlohmann::ordered_json;
using plan::SurveyItem;
using records::EventKind;
using screen::Shown;

constexpr const char* kRatingScale = "1 very little, 5 very much";
constexpr const char* kExertionScale = "0 nothing at all, 10 extremely strong";
constexpr double kAnswerWithinS = 24 * 3600;  // A wait for a person has no end worth naming.
/// Asks here in place of the participant's screen.
constexpr char kHereKey = 't';

/// The scale of an item; both ends 0: free text.
struct Scale {
  EventKind kind = EventKind::kAnswer;
  int least = 0, greatest = 0;
  const char* ends = "";
};

Scale ScaleOf(plan::SurveyScale scale) {
  switch (scale) {
    case plan::SurveyScale::kRating:
      return {EventKind::kRating, plan::kLeastRating, plan::kMostRating, kRatingScale};
    case plan::SurveyScale::kExertion:
      return {EventKind::kExertion, 0, plan::kMostExertion, kExertionScale};
    case plan::SurveyScale::kText:
    case plan::SurveyScale::kChoice:
      return {};
  }
  return {};
}

std::string TitleOf(const SurveyItem& item) {
  if (item.interface.empty()) return "The whole study";
  return (item.at_end ? "Looking back: interface " : "Interface ") + item.interface;
}

class SurveyRun {
 public:
  SurveyRun(SessionContext& context, const std::vector<SurveyItem>& items)
      : context_(context),
        items_(items),
        respondent_{context.options.answer_seed, context.session.participant} {}

  Result<void> Run(const SurveyItem& item) {
    const Scale scale = ScaleOf(item.scale);
    const bool text = scale.kind == EventKind::kAnswer;
    ordered_json fields = {{text ? "question" : "item", item.item}};
    if (context_.options.unattended) {
      // A look back is answered independently of what was said right after the interface.
      const std::string about = (item.at_end ? "end " : "") + item.interface;
      if (!item.choices.empty()) {
        fields["text"] = respondent_.Choose(about, item.item, item.choices);
      } else if (text) {
        fields["text"] = respondent_.Answer(about, item.item);
      } else {
        fields["value"] = respondent_.Rate(about, item.item, scale.least, scale.greatest);
      }
    } else {
      auto asked = Ask(item, Question(item, scale));
      if (!asked) return asked.error();
      if (!item.choices.empty()) {
        fields["text"] = *screen::ParseChoice(*asked, item.choices);
      } else if (text) {
        fields["text"] = std::move(*asked);
      } else {
        fields["value"] = *screen::ParseRating(*asked, scale.least, scale.greatest);
      }
    }
    fields["interface"] = item.interface;
    fields["at_end"] = item.at_end;
    fields["synthetic"] = context_.options.unattended;
    return context_.journal.Append(scale.kind, std::move(fields));
  }

 private:
  Shown Question(const SurveyItem& item, const Scale& scale) const {
    const auto place = std::find(items_.begin(), items_.end(), item);
    return {.title = TitleOf(item),
            .item = item.item,
            .scale = scale.ends,
            .least = scale.least,
            .greatest = scale.greatest,
            .position = static_cast<int>(place - items_.begin()) + 1,
            .count = static_cast<int>(items_.size()),
            .choices = item.choices};
  }

  Result<std::string> Ask(const SurveyItem& item, const Shown& question) {
    if (context_.screen != nullptr && !here_) {
      auto answer = AskOnScreen(question);
      if (!answer) return answer.error();
      if (*answer) return std::move(**answer);
      here_ = true;
    }
    return AskHere(item, question);
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

  Result<std::string> AskHere(const SurveyItem& item, const Shown& question) {
    const std::string about = item.at_end && !item.interface.empty() ? item.interface + ": " : "";
    const std::string range =
        std::to_string(question.least) + " to " + std::to_string(question.greatest);
    const bool exertion = question.greatest == plan::kMostExertion;
    const bool choice = !question.choices.empty();
    const std::string prompt =
        choice ? question.item + " (" + screen::ChoiceLine(question.choices) + "):"
        : question.is_rating()
            ? question.item + (exertion ? " (" + question.scale + ")" : "") + ", " + range + ":"
            : question.item + " (one line):";
    for (;;) {
      auto text = context_.console.Ask("  " + about + prompt);
      if (!text || screen::Answers(question, *text)) return text;
      context_.console.Print(choice ? "  Type one of them: the number or the name."
                                    : "  Type a whole number from " + range + ".");
    }
  }

  SessionContext& context_;
  const std::vector<SurveyItem>& items_;
  Respondent respondent_;
  bool here_ = false;  ///< The experimenter asks in the terminal.
};

/// Heading for the experimenter before the first question.
std::string Heading(const std::vector<SurveyItem>& items, std::size_t left) {
  std::string heading = "Survey";
  if (items.front().at_end) {
    heading += " at the end";
  } else if (!items.front().interface.empty()) {
    heading += ", interface " + items.front().interface;
  }
  heading += std::string(": ") + kRatingScale + ".";
  if (left == items.size()) return heading;
  return heading + " It goes on with question " + std::to_string(items.size() - left + 1) + " of " +
         std::to_string(items.size()) + ".";
}

}  // namespace

Result<void> RunSurvey(SessionContext& context, const std::vector<SurveyItem>& items) {
  const auto left = records::Unanswered(items, context.journal.events());
  if (left.empty()) return {};
  if (!context.options.unattended) context.console.Print(Heading(items, left.size()));
  SurveyRun run(context, items);
  Result<void> done;
  for (auto item = left.begin(); item != left.end() && done; ++item) done = run.Run(*item);
  if (context.screen != nullptr) context.screen->Say("Thank you. Please wait.");
  return done;
}

int Respondent::Rate(const std::string& interface, const std::string& item, int least,
                     int greatest) const {
  plan::Draw draw(seed, "rating " + participant + " " + interface + " " + item);
  return least + static_cast<int>(draw.Below(static_cast<std::size_t>(greatest - least + 1)));
}

std::string Respondent::Choose(const std::string& interface, const std::string& question,
                               const std::vector<std::string>& choices) const {
  plan::Draw draw(seed, "choice " + participant + " " + interface + " " + question);
  return choices[draw.Below(choices.size())];
}

std::string Respondent::Answer(const std::string& interface, const std::string& question) const {
  plan::Draw draw(seed, "answer " + participant + " " + interface + " " + question);
  return "synthetic answer " + std::to_string(draw.Below(1000));
}

namespace {
constexpr std::size_t kMostScreens = 4;
}  // namespace

Result<std::unique_ptr<SurveyScreen>> SurveyScreen::Open(Console& console,
                                                         const transport::Address& address) {
  std::unique_ptr<SurveyScreen> screen(new SurveyScreen);
  auto listener = transport::Listener::Open(
      console.io(), address,
      [own = screen.get()](transport::Socket socket) { own->Accept(std::move(socket)); });
  if (!listener) return listener.error();
  screen->listener_ = std::move(*listener);
  screen->Say("The survey will be here. Please wait.");
  return screen;
}

void SurveyScreen::Accept(transport::Socket socket) {
  std::erase_if(connections_, [](const auto& one) { return !one->open(); });
  if (connections_.size() == kMostScreens) connections_.erase(connections_.begin());
  connections_.push_back(std::make_unique<transport::FramedConnection>(
      std::move(socket), transport::FramedLimits{.max_in_bytes = screen::kMostFrameBytes},
      transport::FramedHandlers{.on_frame = [this](std::string_view payload) { OnFrame(payload); },
                                .on_close = [](const std::string&) {},  // It comes back.
                                .on_writable = {},
                                .on_bytes = {},
                                .on_bad_input = {}}));
  connections_.back()->Start();
  connections_.back()->Send(screen::ToText(shown_));
}

void SurveyScreen::OnFrame(std::string_view payload) {
  const auto reply = screen::ParseReply(payload);
  if (!reply || reply->number != shown_.number || shown_.number == 0 || answer_) return;
  if (!screen::Answers(shown_, reply->text)) return;
  answer_ = reply->text.substr(0, screen::kMostAnswerBytes);
}

bool SurveyScreen::connected() const {
  return std::any_of(connections_.begin(), connections_.end(),
                     [](const auto& one) { return one->open(); });
}

void SurveyScreen::Ask(screen::Shown question) {
  question.number = ++asked_;
  Show(std::move(question));
}

void SurveyScreen::Say(const std::string& message) { Show({.item = message}); }

void SurveyScreen::Show(screen::Shown shown) {
  shown_ = std::move(shown);
  answer_.reset();
  for (const auto& one : connections_) {
    if (one->open()) one->Send(screen::ToText(shown_));
  }
}

}  // namespace footing::study
