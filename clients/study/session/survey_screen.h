#pragma once

#include <memory>
#include <optional>
#include <string>

#include "clients/study/plan/screen_message.h"
#include "clients/study/session/console.h"
#include "common/base/result.h"
#include "common/net/address.h"

namespace footing::study {

/// The participant's survey screen, footing-study survey, as its server. What is shown stays until
/// something else is, whichever screen comes and goes. At most four screens show it; the first
/// answer counts.
class SurveyScreen {
 public:
  /// Listens; errors say which address, why, and what to do.
  static Result<std::unique_ptr<SurveyScreen>> Open(Console& console,
                                                    const transport::Address& address);
  ~SurveyScreen();
  SurveyScreen(const SurveyScreen&) = delete;
  SurveyScreen& operator=(const SurveyScreen&) = delete;

  const transport::Address& address() const;
  bool connected() const;

  /// Shows a question, to which a number of its own is given.
  void Ask(screen::Shown question);
  /// Shows a message in its place.
  void Say(const std::string& message);
  /// The answer to the question, once it has come; an answer to another one, or one outside of a
  /// rating's range, is dropped.
  std::optional<std::string> TakeAnswer();

 private:
  class Implementation;
  explicit SurveyScreen(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace footing::study
