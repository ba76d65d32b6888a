#include "clients/study/session/survey_screen.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/net/framed_connection.h"
#include "common/net/listener.h"

namespace footing::study {

namespace {
constexpr std::size_t kMostScreens = 4;
}  // namespace

class SurveyScreen::Implementation {
 public:
  Result<void> Open(Console& console, const transport::Address& address) {
    auto listener = transport::Listener::Open(
        console.io(), address, [this](transport::Socket socket) { Accept(std::move(socket)); });
    if (!listener) return listener.error();
    listener_ = std::move(*listener);
    return {};
  }

  void Accept(transport::Socket socket) {
    std::erase_if(connections_, [](const auto& one) { return !one->open(); });
    if (connections_.size() == kMostScreens) connections_.erase(connections_.begin());
    connections_.push_back(std::make_unique<transport::FramedConnection>(
        std::move(socket), transport::FramedLimits{.max_in_bytes = screen::kMostFrameBytes},
        transport::FramedHandlers{
            .on_frame = [this](std::string_view payload) { OnFrame(payload); },
            .on_close = [](const std::string&) {},  // It comes back.
            .on_writable = {},
            .on_bytes = {},
            .on_bad_input = {}}));
    connections_.back()->Start();
    connections_.back()->Send(screen::ToText(shown_));
  }

  void OnFrame(std::string_view payload) {
    const auto reply = screen::ParseReply(payload);
    if (!reply || reply->number != shown_.number || shown_.number == 0 || answer_) return;
    if (!screen::Answers(shown_, reply->text)) return;
    answer_ = reply->text.substr(0, screen::kMostAnswerBytes);
  }

  void Send() {
    for (const auto& one : connections_) {
      if (one->open()) one->Send(screen::ToText(shown_));
    }
  }

  std::unique_ptr<transport::Listener> listener_;
  std::vector<std::unique_ptr<transport::FramedConnection>> connections_;  ///< Oldest first.
  screen::Shown shown_;
  std::uint64_t asked_ = 0;  ///< Questions so far.
  std::optional<std::string> answer_;
};

SurveyScreen::SurveyScreen(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
SurveyScreen::~SurveyScreen() = default;

Result<std::unique_ptr<SurveyScreen>> SurveyScreen::Open(Console& console,
                                                         const transport::Address& address) {
  auto own = std::make_unique<Implementation>();
  if (const auto done = own->Open(console, address); !done) return done.error();
  std::unique_ptr<SurveyScreen> screen(new SurveyScreen(std::move(own)));
  screen->Say("The survey will be here. Please wait.");
  return screen;
}

const transport::Address& SurveyScreen::address() const {
  return implementation_->listener_->address();
}

bool SurveyScreen::connected() const {
  return std::any_of(implementation_->connections_.begin(), implementation_->connections_.end(),
                     [](const auto& one) { return one->open(); });
}

void SurveyScreen::Ask(screen::Shown question) {
  question.number = ++implementation_->asked_;
  implementation_->shown_ = std::move(question);
  implementation_->answer_.reset();
  implementation_->Send();
}

void SurveyScreen::Say(const std::string& message) {
  implementation_->shown_ = {.item = message};
  implementation_->answer_.reset();
  implementation_->Send();
}

std::optional<std::string> SurveyScreen::TakeAnswer() {
  return std::exchange(implementation_->answer_, std::nullopt);
}

}  // namespace footing::study
