#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "clients/study/plan/protocol.h"
#include "clients/study/plan/screen_message.h"
#include "clients/study/session/console.h"
#include "clients/study/session/session_context.h"
#include "common/base/result.h"
#include "common/net/address.h"
#include "common/net/framing.h"
#include "common/net/listener.h"

namespace footing::study {

/// Asks what has no answer in the journal yet, on the participant's screen where there is one, else
/// in the terminal, and writes each answer into the journal before the next question. `items` are
/// those of one survey.
Result<void> RunSurvey(SessionContext& context, const std::vector<plan::SurveyItem>& items);

/// Answers of a participant who is not there: random, from a seed. Whatever they answer is marked
/// synthetic in the journal.
struct Respondent {
  std::uint64_t seed = 1;
  std::string participant;

  /// A whole number from `least` to `greatest`, each as likely.
  int Rate(const std::string& interface, const std::string& item, int least, int greatest) const;
  /// One of them, each as likely. `choices` must not be empty.
  std::string Choose(const std::string& interface, const std::string& question,
                     const std::vector<std::string>& choices) const;
  std::string Answer(const std::string& interface, const std::string& question) const;
};

/// The participant's survey screen, footing-study survey, as its server. What is shown stays until
/// something else is, whichever screen comes and goes. At most four screens show it; the first
/// answer counts.
class SurveyScreen {
 public:
  /// Listens; errors say which address, why, and what to do.
  static Result<std::unique_ptr<SurveyScreen>> Open(Console& console,
                                                    const transport::Address& address);
  SurveyScreen(const SurveyScreen&) = delete;
  SurveyScreen& operator=(const SurveyScreen&) = delete;

  const transport::Address& address() const { return listener_->address(); }
  bool connected() const;

  /// Shows a question, to which a number of its own is given.
  void Ask(screen::Shown question);
  /// Shows a message in its place.
  void Say(const std::string& message);
  /// The answer to the question, once it has come; an answer to another one, or one outside of a
  /// rating's range, is dropped.
  std::optional<std::string> TakeAnswer() { return std::exchange(answer_, std::nullopt); }

 private:
  SurveyScreen() = default;
  void Accept(transport::Socket socket);
  void OnFrame(std::string_view payload);
  void Show(screen::Shown shown);

  std::unique_ptr<transport::Listener> listener_;
  std::vector<std::unique_ptr<transport::FramedConnection>> connections_;  ///< Oldest first.
  screen::Shown shown_;
  std::uint64_t asked_ = 0;  ///< Questions so far.
  std::optional<std::string> answer_;
};

}  // namespace footing::study
